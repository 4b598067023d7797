"""How alike two codes are, for chosen pairs of rows: by what they share of their total, or by their angle."""

from __future__ import annotations

from typing import Literal

import numpy as np
from jaxtyping import Float32, Int64
from numba import njit
from numpy.typing import NDArray

__all__ = ["Similarity", "match_all", "match_pairs"]

Similarity = Literal["overlap", "cosine"]


def match_pairs(
    queries: Float32[np.ndarray, "points size"],
    memory: Float32[np.ndarray, "units size"],
    query_index: Int64[np.ndarray, " pairs"],
    memory_index: Int64[np.ndarray, " pairs"],
    similarity: Similarity = "overlap",
) -> Float32[np.ndarray, " pairs"]:
    """The similarity of each pair of rows (queries[query_index[i]], memory[memory_index[i]]), 0..1.

    "overlap" is 1 - L1(a, b) / (L1(a) + L1(b)), "cosine" that of the angle, negative ones as 0. Equal rows have 1,
    also where they are zero; a zero row has nothing in common with another.
    """
    return _compare(queries, memory, query_index, memory_index, similarity == "cosine")


def match_all(
    queries: Float32[np.ndarray, "points size"],
    memory: Float32[np.ndarray, "units size"],
    similarity: Similarity = "overlap",
) -> Float32[np.ndarray, "points units"]:
    """The similarity of every query row with every memory row."""
    shape = len(memory), len(queries)
    # Unit by unit: the long memory is read once, the few queries stay in cache.
    memory_index, query_index = np.divmod(np.arange(shape[0] * shape[1]), max(shape[1], 1))
    return np.ascontiguousarray(match_pairs(queries, memory, query_index, memory_index, similarity).reshape(shape).T)


# fastmath lets the sums run in vector lanes; it is the one kernel behind every comparison, so equal pairs of rows
# give bitwise equal results whichever other pairs are asked for. Its parts are inlined before it is optimised, so that
# no call stands in the way of that.
@njit(cache=True, fastmath=True)
def _compare(
    queries: NDArray[np.float32],
    memory: NDArray[np.float32],
    query_index: NDArray[np.int64],
    memory_index: NDArray[np.int64],
    angles: bool,
) -> NDArray[np.float32]:
    result = np.empty(len(query_index), np.float32)
    for pair in range(len(query_index)):
        query, unit = queries[query_index[pair]], memory[memory_index[pair]]
        result[pair] = _cosine(query, unit) if angles else _overlap(query, unit)
    return result


@njit(cache=True, fastmath=True, inline="always")
def _overlap(query: NDArray[np.float32], unit: NDArray[np.float32]) -> np.float32:
    apart, total = np.float32(0), np.float32(0)
    for i in range(len(query)):
        apart += abs(query[i] - unit[i])
        total += abs(query[i]) + abs(unit[i])
    return np.float32(1) - apart / total if total > 0 else np.float32(1)


@njit(cache=True, fastmath=True, inline="always")
def _cosine(query: NDArray[np.float32], unit: NDArray[np.float32]) -> np.float32:
    product, first, second = np.float32(0), np.float32(0), np.float32(0)
    for i in range(len(query)):
        product += query[i] * unit[i]
        first += query[i] * query[i]
        second += unit[i] * unit[i]
    lengths = np.sqrt(first) * np.sqrt(second)
    if lengths > 0:
        return min(max(product / lengths, np.float32(0)), np.float32(1))
    return np.float32(first == second)
