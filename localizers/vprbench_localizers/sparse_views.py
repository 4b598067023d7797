"""The views of every learned place, of whose signatures only the values that are not zero are kept."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int64
from numba import njit
from numpy.typing import NDArray

from vprbench.errors import PluginError
from vprbench_localizers.growing import Growing
from vprbench_localizers.unit_activity import View

__all__ = ["SparseViews"]


class SparseViews:
    """Views one after another, each of which comes back as it was, bit by bit.

    A value takes 8 bytes for the 4 of a dense signature: of HSD-15/30's 225 values 5 are kept, of log-polar's all.
    """

    def __init__(self) -> None:
        self._size = 0
        self._values, self._columns = Growing(np.float32), Growing(np.uint32)
        self._value_ends, self._azimuths = Growing(np.int64), Growing(np.float32)
        self._unit_ends = Growing(np.int64)

    @property
    def units(self) -> int:
        """How many landmarks are stored."""
        return len(self._azimuths)

    def __len__(self) -> int:
        return len(self._unit_ends)

    def __getitem__(self, place: int) -> View:
        """The view of a place."""
        first, end = (int(self._unit_ends.rows[place - 1]) if place else 0), int(self._unit_ends.rows[place])
        signatures = np.zeros((end - first, self._size), np.float32)
        _fill(signatures, first, self._value_ends.rows, self._columns.rows, self._values.rows)
        return View(signatures, self._azimuths.rows[first:end].copy())

    def add(self, view: View) -> int:
        """Store a view; its place's index.

        Raises:
            PluginError: its signatures are of another size than those stored.
        """
        if len(view.azimuths):
            self._require(view.signatures.shape[1])
            rows, columns = np.nonzero(view.signatures)
            self._value_ends.extend(len(self._values) + np.searchsorted(rows, np.arange(len(view.azimuths)), "right"))
            self._values.extend(view.signatures[rows, columns])
            self._columns.extend(columns)
            self._azimuths.extend(view.azimuths)
        self._unit_ends.extend(np.array([self.units]))
        return len(self) - 1

    def places_of(self, units: Int64[np.ndarray, " units"]) -> Int64[np.ndarray, " units"]:
        """The place that each unit, counted through all places, belongs to."""
        return np.searchsorted(self._unit_ends.rows, units, "right")

    def _require(self, size: int) -> None:
        if self.units and size != self._size:
            raise PluginError(
                f"the encoder gives signatures of {size} values, the places stored have {self._size}:"
                " clear them after fitting an encoder again"
            )
        self._size = size


@njit(cache=True)
def _fill(
    signatures: NDArray[np.float32],
    first: int,
    value_ends: NDArray[np.int64],
    columns: NDArray[np.uint32],
    values: NDArray[np.float32],
) -> None:
    """Write the values of some units in a row, the first of which is given, into signatures of zeros."""
    at = value_ends[first - 1] if first else 0
    for row in range(len(signatures)):
        while at < value_ends[first + row]:
            signatures[row, columns[at]] = values[at]
            at += 1
