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

    "overlap" is 1 - L1(a, b) / (L1(a) + L1(b)), the Bray-Curtis similarity; "cosine" that of the angle, negative ones
    as 0. Equal rows have 1, also where they are zero; a zero row has nothing in common with another.
    """
    compare = _cosines if similarity == "cosine" else _overlaps
    return compare(queries, memory, query_index, memory_index)


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


@njit(cache=True)
def _overlaps(
    queries: NDArray[np.float32],
    memory: NDArray[np.float32],
    query_index: NDArray[np.int64],
    memory_index: NDArray[np.int64],
) -> NDArray[np.float32]:
    """What two rows share, of all that they have: 2 sum of shares / (L1(a) + L1(b)), which is 1 - L1(a, b) / (...).

    Where either is zero they share nothing, so that a sparse query tells which values matter. Sums run in float32 from
    the first value to the last: a memory of non-zero values alone adds up the same bits.
    """
    used, counts = _used(queries)
    asked, held = _lengths(queries), _lengths(memory)
    result = np.empty(len(query_index), np.float32)
    for pair in range(len(query_index)):
        query, unit = query_index[pair], memory_index[pair]
        common, total = np.float32(0), asked[query] + held[unit]
        for i in used[query, : counts[query]]:
            common += _share(queries[query, i], memory[unit, i])
        result[pair] = np.float32(2) * common / total if total > 0 else np.float32(1)
    return result


@njit(cache=True)
def _share(one: np.float32, other: np.float32) -> np.float32:
    """What two values have in common: the smaller, if both have one sign."""
    # Of positive ones min(one, other), of negative ones -max(one, other): without a branch, which would be a coin toss.
    return max(min(one, other), np.float32(0)) - min(max(one, other), np.float32(0))


@njit(cache=True)
def _used(codes: NDArray[np.float32]) -> tuple[NDArray[np.uint32], NDArray[np.int64]]:
    """The positions of each row's non-zero values, in order, and how many there are."""
    used, counts = np.empty(codes.shape, np.uint32), np.zeros(len(codes), np.int64)
    for row in range(len(codes)):
        for i in range(codes.shape[1]):
            if codes[row, i] != 0:
                used[row, counts[row]] = i
                counts[row] += 1
    return used, counts


@njit(cache=True)
def _lengths(codes: NDArray[np.float32]) -> NDArray[np.float32]:
    """L1 of each row."""
    lengths = np.zeros(len(codes), np.float32)
    for row in range(len(codes)):
        for i in range(codes.shape[1]):
            lengths[row] += abs(codes[row, i])
    return lengths


@njit(cache=True)
def _cosines(
    queries: NDArray[np.float32],
    memory: NDArray[np.float32],
    query_index: NDArray[np.int64],
    memory_index: NDArray[np.int64],
) -> NDArray[np.float32]:
    result = np.empty(len(query_index), np.float32)
    for pair in range(len(query_index)):
        product, first, second = _products(queries[query_index[pair]], memory[memory_index[pair]])
        # Of equal rows the root is exact, so that they match with 1.
        lengths = np.sqrt(first * second)
        alike = product / lengths if lengths > 0 else np.float32(first == second)
        result[pair] = min(max(alike, np.float32(0)), np.float32(1))
    return result


# fastmath lets the sums run in vector lanes; it is the one kernel behind every comparison, so equal pairs of rows
# give bitwise equal results whichever other pairs are asked for.
@njit(cache=True, fastmath=True)
def _products(query: NDArray[np.float32], unit: NDArray[np.float32]) -> tuple[np.float32, np.float32, np.float32]:
    """The product of two rows, and of each with itself."""
    product, first, second = np.float32(0), np.float32(0), np.float32(0)
    for i in range(len(query)):
        product += query[i] * unit[i]
        first += query[i] * query[i]
        second += unit[i] * unit[i]
    return product, first, second
