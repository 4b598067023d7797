"""The regions of every learned place, in one contiguous array that grows."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32

from vprbench_localizers.region_match import PLANES_SHAPE

__all__ = ["PlaceMemory"]


class PlaceMemory:
    """Places one after another; adding one costs the same however many there are."""

    def __init__(self) -> None:
        self._count = 0
        self._store = np.empty((8, *PLANES_SHAPE), np.float32)

    @property
    def planes(self) -> Float32[np.ndarray, "places 9 1056"]:
        """The planes of each place; a view that the next `add` may leave behind."""
        return self._store[: self._count]

    def __len__(self) -> int:
        return self._count

    def add(self, planes: Float32[np.ndarray, "9 1056"]) -> int:
        """Store a place; its index."""
        if self._count == len(self._store):
            # Doubling makes all the copies together cost less than two writes a place.
            grown = np.empty((2 * self._count, *PLANES_SHAPE), np.float32)
            grown[: self._count] = self._store
            self._store = grown
        self._store[self._count] = planes
        self._count += 1
        return self._count - 1
