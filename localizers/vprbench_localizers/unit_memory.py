"""The landmarks of every learned place, in contiguous arrays that grow."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float32, Int64, UInt8
from numpy.typing import NDArray

from vprbench_localizers.growing import Growing, with_room
from vprbench_localizers.signature_size import require_size
from vprbench_localizers.unit_activity import View

__all__ = ["UnitMemory", "Units"]


class Units(NamedTuple):
    """The units of some places in a row.

    Shapes and units:
        signatures: float32 or uint8 (units, size), as in the views stored.
        azimuths: float32 (units,), radians in -pi..pi.
        starts: int64 (places + 1,), the first unit of each place, and the end of the last.
    """

    signatures: Float32[np.ndarray, "units size"] | UInt8[np.ndarray, "units size"]
    azimuths: Float32[np.ndarray, " units"]
    starts: Int64[np.ndarray, " places_and_end"]


class UnitMemory:
    """One unit for each learned landmark, place after place; adding costs the same however many there are.

    Attributes:
        units: how many landmarks are stored.
    """

    def __init__(self) -> None:
        self.units = 0
        self._starts = Growing(np.int64)
        self._starts.extend(np.zeros(1, np.int64))
        self._signatures: NDArray[Any] = np.empty((0, 0), np.float32)
        self._azimuths = np.empty(0, np.float32)

    @property
    def starts(self) -> Int64[np.ndarray, " places_and_end"]:
        """The first unit of each place, and the end of the last; a view that the next `add` may leave behind."""
        return self._starts.rows

    @property
    def signatures(self) -> Float32[np.ndarray, "units size"] | UInt8[np.ndarray, "units size"]:
        """Signature of each unit; a view that the next `add` may leave behind."""
        return self._signatures[: self.units]

    @property
    def azimuths(self) -> Float32[np.ndarray, " units"]:
        """Azimuth of each unit, radians; a view that the next `add` may leave behind."""
        return self._azimuths[: self.units]

    def blocks(self, places: int) -> Iterator[Units]:
        """The memory, so many places at a time; views that the next `add` may leave behind."""
        starts = self.starts
        for first in range(0, len(self), places):
            here = starts[first : first + places + 1]
            span = slice(here[0], here[-1])
            yield Units(self._signatures[span], self._azimuths[span], here - here[0])

    def __len__(self) -> int:
        return len(self._starts) - 1

    def add(self, view: View) -> int:
        """Store a place; its index. A place without landmarks has no unit.

        Raises:
            PluginError: its signatures are of another size than those stored.
        """
        end = self.units + len(view.azimuths)
        if end > self.units:
            self._reserve(end, view)
            self._signatures[self.units : end] = view.signatures
            self._azimuths[self.units : end] = view.azimuths
        self.units = end
        self._starts.extend(np.array([end]))
        return len(self) - 1

    def require(self, view: View) -> None:
        """Refuse a view whose signatures are of another size than those stored; there must be some.

        Raises:
            PluginError: they are.
        """
        require_size(view.signatures.shape[1], self._signatures.shape[1])

    def _reserve(self, units: int, view: View) -> None:
        if self.units:
            self.require(view)
        else:
            self._signatures = np.empty((0, view.signatures.shape[1]), view.signatures.dtype)
        self._signatures = with_room(self._signatures, units, self.units)
        self._azimuths = with_room(self._azimuths, units, self.units)
