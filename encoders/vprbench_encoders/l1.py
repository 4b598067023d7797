"""The mean absolute difference of signatures, for chosen pairs of rows."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Int64, UInt8
from numba import njit
from numpy.typing import NDArray

__all__ = ["mean_l1", "mean_l1_pairs"]


# fastmath lets the sum run in vector lanes; it is the one kernel behind every comparison, so equal pairs of
# rows give bitwise equal results whichever other pairs are asked for.
@njit(cache=True, fastmath=True)
def _mean_l1(
    queries: NDArray[np.float32],
    memory: NDArray[np.float32],
    query_index: NDArray[np.int64],
    memory_index: NDArray[np.int64],
) -> NDArray[np.float32]:
    size = queries.shape[1]
    result = np.empty(len(query_index), np.float32)
    for pair in range(len(query_index)):
        query, unit = queries[query_index[pair]], memory[memory_index[pair]]
        total = np.float32(0.0)
        for i in range(size):
            total += abs(query[i] - unit[i])
        result[pair] = total / np.float32(size)
    return result


@njit(cache=True)
def _mean_l1_of_bytes(
    queries: NDArray[np.uint8],
    memory: NDArray[np.uint8],
    query_index: NDArray[np.int64],
    memory_index: NDArray[np.int64],
) -> NDArray[np.float32]:
    size = queries.shape[1]
    result = np.empty(len(query_index), np.float32)
    for pair in range(len(query_index)):
        query, unit = queries[query_index[pair]], memory[memory_index[pair]]
        total = np.int32(0)
        for i in range(size):
            # Written in 32 bits throughout, so that LLVM finds the instruction for sums of differences of bytes.
            total = np.int32(total + np.int32(abs(np.int32(np.int32(query[i]) - np.int32(unit[i])))))
        result[pair] = np.float32(total) / np.float32(255 * size)
    return result


def mean_l1_pairs(
    queries: Float32[np.ndarray, "points size"] | UInt8[np.ndarray, "points size"],
    memory: Float32[np.ndarray, "units size"] | UInt8[np.ndarray, "units size"],
    query_index: Int64[np.ndarray, " pairs"],
    memory_index: Int64[np.ndarray, " pairs"],
) -> Float32[np.ndarray, " pairs"]:
    """Mean |x - w| of each pair of rows (queries[query_index[i]], memory[memory_index[i]]); bytes are 255ths of 1."""
    kernel = _mean_l1_of_bytes if memory.dtype == np.uint8 else _mean_l1
    return kernel(queries, memory, query_index, memory_index)


def mean_l1(
    queries: Float32[np.ndarray, "points size"], memory: Float32[np.ndarray, "units size"]
) -> Float32[np.ndarray, "points units"]:
    """Mean |x - w| of every query row with every memory row."""
    shape = len(queries), len(memory)
    # Unit by unit: the long memory is read once, the few queries stay in cache.
    memory_index, query_index = np.divmod(np.arange(shape[0] * shape[1]), max(shape[0], 1))
    return _mean_l1(queries, memory, query_index, memory_index).reshape(shape[::-1]).T
