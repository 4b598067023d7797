"""The mean absolute difference of signatures, for chosen pairs of rows."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Int64
from numba import njit
from numpy.typing import NDArray

__all__ = ["mean_l1", "mean_l1_pairs", "mean_l1_pairs_within"]

# Rows of a map that are added up before maps are compared. A log-polar map changes little from one radius to the next,
# so that the sums tell of nine in ten of LPMP's pairs beyond the limit on KITTI that they are.
TOGETHER = 9

# Far above what rounding can do to a mean of differences of values in 0..1: below 2e-4 for maps of 54 x 54.
ROUNDING = 1e-3


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


def mean_l1_pairs(
    queries: Float32[np.ndarray, "points size"],
    memory: Float32[np.ndarray, "units size"],
    query_index: Int64[np.ndarray, " pairs"],
    memory_index: Int64[np.ndarray, " pairs"],
) -> Float32[np.ndarray, " pairs"]:
    """Mean |x - w| of each pair of rows (queries[query_index[i]], memory[memory_index[i]])."""
    return _mean_l1(queries, memory, query_index, memory_index)


@njit(cache=True)
def _row_sums(bands: NDArray[np.float32]) -> NDArray[np.float32]:
    """The sum over the rows of each band, from (maps, bands, rows, columns)."""
    sums = np.empty((bands.shape[0], bands.shape[1], bands.shape[3]), np.float32)
    for m in range(bands.shape[0]):
        for band in range(bands.shape[1]):
            for column in range(bands.shape[3]):
                total = np.float32(0)
                # A number known when it is compiled, so that columns are summed side by side in vector lanes.
                for row in range(TOGETHER):
                    total += bands[m, band, row, column]
                sums[m, band, column] = total
    return sums


def mean_l1_pairs_within(
    queries: Float32[np.ndarray, "points size"],
    memory: Float32[np.ndarray, "units size"],
    query_index: Int64[np.ndarray, " pairs"],
    memory_index: Int64[np.ndarray, " pairs"],
    limit: float,
    side: int,
) -> Float32[np.ndarray, " pairs"]:
    """Mean |x - w| of each pair of rows, bit for bit, where it is at most `limit`; elsewhere any value above that.

    A row is a square map of values in 0..1. Sums over its rows differ by no more than the values do, and are compared
    first: only pairs that they leave in doubt are compared in full.

    Args:
        queries: maps, one a row.
        memory: maps, one a row.
        query_index: of each pair.
        memory_index: of each pair.
        limit: of the mean absolute difference.
        side: rows and columns of a map, a multiple of `TOGETHER`.
    """
    bands = side // TOGETHER, TOGETHER, side
    asked, held = (_row_sums(maps.reshape(-1, *bands)).reshape(len(maps), -1) for maps in (queries, memory))
    result = _mean_l1(asked, held, query_index, memory_index) / np.float32(TOGETHER)
    (doubtful,) = np.nonzero(result <= limit + ROUNDING)
    # By the one kernel of all comparisons, since another would add in another order.
    result[doubtful] = _mean_l1(queries, memory, query_index[doubtful], memory_index[doubtful])
    return result


def mean_l1(
    queries: Float32[np.ndarray, "points size"], memory: Float32[np.ndarray, "units size"]
) -> Float32[np.ndarray, "points units"]:
    """Mean |x - w| of every query row with every memory row."""
    shape = len(queries), len(memory)
    # Unit by unit: the long memory is read once, the few queries stay in cache.
    memory_index, query_index = np.divmod(np.arange(shape[0] * shape[1]), max(shape[0], 1))
    return _mean_l1(queries, memory, query_index, memory_index).reshape(shape[::-1]).T
