"""Topographic max pooling: neighbouring units of a map, which code alike features, become one value."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Int64
from numba import njit
from numpy.typing import NDArray

from vprbench_encoders.matching_pursuit import SparseCode

__all__ = ["max_pool", "pooled_side", "pooling_cells"]


def pooled_side(side: int, width: int) -> int:
    """Rows and columns that are left of a side x side map.

    The paper's signature sizes, 36, 64, 81, 100, 144, 225 for n = 12, 15, 18, 21, 24, 30, are those of n/2 rounded
    half to even: of a map with an odd side, the last row is a window of its own or belongs to none.
    """
    return max(round(side / width), 1)


def pooling_cells(side: int, width: int) -> Int64[np.ndarray, " units"]:
    """The pooled cell of each unit of a side x side map, row after row; -1 for a unit in no window.

    Windows are the rows and columns [i width, min((i + 1) width, side)).
    """
    cells = pooled_side(side, width)
    along = np.arange(side) // width
    row, column = np.meshgrid(along, along, indexing="ij")
    return np.where((row < cells) & (column < cells), row * cells + column, -1).ravel()


def max_pool(code: SparseCode, cells: Int64[np.ndarray, " units"]) -> Float32[np.ndarray, "samples cells"]:
    """The largest magnitude in each cell, zero where no unit of it is active."""
    pooled = np.zeros((len(code.atoms), int(cells.max()) + 1), np.float32)
    _scatter_max(*code, cells, pooled)
    return pooled


@njit(cache=True)
def _scatter_max(
    atoms: NDArray[np.int32], values: NDArray[np.float32], cells: NDArray[np.int64], pooled: NDArray[np.float32]
) -> None:
    for sample in range(len(atoms)):
        for slot in range(atoms.shape[1]):
            cell = cells[atoms[sample, slot]]
            if cell >= 0:
                pooled[sample, cell] = max(pooled[sample, cell], abs(values[sample, slot]))
