"""The views of every learned place, of whose signatures only the values that are not zero are kept."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int64, UInt16
from numba import njit
from numpy.typing import NDArray

from vprbench.errors import PluginError
from vprbench_localizers.growing import Growing
from vprbench_localizers.signature_size import require_size
from vprbench_localizers.unit_activity import View

__all__ = ["SparseUnits", "SparseViews"]

# Columns are counted in 16 bits.
LARGEST = 2**16


class SparseUnits(NamedTuple):
    """The landmarks of places in a row, as arrays.

    Shapes and units:
        place_ends: int64 (places,), the unit after the last of each place.
        unit_ends: int64 (units,), the value after the last of each unit.
        columns: uint16 (values,), where in its signature a value stands, rising within a unit.
        values: float32 (values,), none of them 0.
        azimuths: float32 (units,), radians in -pi..pi.
    """

    place_ends: Int64[np.ndarray, " places"]
    unit_ends: Int64[np.ndarray, " units"]
    columns: UInt16[np.ndarray, " values"]
    values: Float32[np.ndarray, " values"]
    azimuths: Float32[np.ndarray, " units"]


class SparseViews:
    """Views one after another, each of which comes back as it was, bit by bit.

    A value takes 6 bytes for the 4 of a dense signature: of HSD-15/30's 225 values 5 are kept, of log-polar's all.
    """

    def __init__(self) -> None:
        self._size = 0
        self._values, self._columns = Growing(np.float32), Growing(np.uint16)
        self._unit_ends, self._azimuths = Growing(np.int64), Growing(np.float32)
        self._place_ends = Growing(np.int64)

    @property
    def units(self) -> SparseUnits:
        """Every landmark; views that the next `add` may leave behind."""
        kept = self._place_ends, self._unit_ends, self._columns, self._values, self._azimuths
        return SparseUnits(*(one.rows for one in kept))

    def __len__(self) -> int:
        return len(self._place_ends)

    def __getitem__(self, place: int) -> View:
        """The view of a place."""
        units = self.units
        first, end = (int(units.place_ends[place - 1]) if place else 0), int(units.place_ends[place])
        signatures = np.zeros((end - first, self._size), np.float32)
        _fill(signatures, first, units)
        return View(signatures, units.azimuths[first:end].copy())

    def add(self, view: View) -> int:
        """Store a view; its place's index.

        Raises:
            PluginError: its signatures are of another size than those stored, or have more than 65,536 values.
        """
        if len(view.azimuths):
            self.require(view.signatures.shape[1])
            rows, columns = np.nonzero(view.signatures)
            self._unit_ends.extend(len(self._values) + np.searchsorted(rows, np.arange(len(view.azimuths)), "right"))
            self._values.extend(view.signatures[rows, columns])
            self._columns.extend(columns)
            self._azimuths.extend(view.azimuths)
        self._place_ends.extend(np.array([len(self._azimuths)]))
        return len(self) - 1

    def require(self, size: int) -> None:
        """Set the size of all signatures, or refuse another."""
        if len(self._azimuths):
            require_size(size, self._size)
        if size > LARGEST:
            raise PluginError(f"the encoder gives signatures of {size} values: at most {LARGEST} can be kept sparsely")
        self._size = size


@njit(cache=True)
def _fill(signatures: NDArray[np.float32], first: int, units: SparseUnits) -> None:
    """Write the values of some units in a row, the first of which is given, into signatures of zeros."""
    at = units.unit_ends[first - 1] if first else 0
    for row in range(len(signatures)):
        while at < units.unit_ends[first + row]:
            signatures[row, units.columns[at]] = units.values[at]
            at += 1
