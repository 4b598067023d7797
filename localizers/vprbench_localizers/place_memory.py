"""The regions of every learned place, in contiguous arrays that grow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np
from jaxtyping import Float32

from vprbench_localizers.place_search import OUTLINE_SIZE, outline
from vprbench_localizers.region_match import PLANES_SHAPE

__all__ = ["PlaceMemory"]


class PlaceMemory:
    """Places one after another; adding one costs the same however many there are.

    Args:
        room: for so many places, before the memory first grows.
    """

    def __init__(self, room: int = 8) -> None:
        self._count = 0
        self._planes = _aligned(max(room, 1), *PLANES_SHAPE)
        self._outlines = _aligned(max(room, 1), OUTLINE_SIZE)

    @classmethod
    def of(cls, places: Sequence[Float32[np.ndarray, "9 1056"]]) -> Self:
        """A memory of these places."""
        memory = cls(len(places))
        for planes in places:
            memory.add(planes)
        return memory

    @property
    def planes(self) -> Float32[np.ndarray, "places 9 1056"]:
        """The planes of each place; a view that the next `add` may leave behind."""
        return self._planes[: self._count]

    @property
    def outlines(self) -> Float32[np.ndarray, "places 128"]:
        """The outline of each place; a view that the next `add` may leave behind."""
        return self._outlines[: self._count]

    def __len__(self) -> int:
        return self._count

    def add(self, planes: Float32[np.ndarray, "9 1056"]) -> int:
        """Store a place; its index."""
        if self._count == len(self._planes):
            self._planes, self._outlines = _doubled(self._planes), _doubled(self._outlines)
        self._planes[self._count] = planes
        self._outlines[self._count] = outline(planes)
        self._count += 1
        return self._count - 1


def _doubled(array: Float32[np.ndarray, "room *shape"]) -> Float32[np.ndarray, "more_room *shape"]:
    """A copy with as much room again: all the copies together cost less than two writes a place."""
    grown = _aligned(2 * len(array), *array.shape[1:])
    grown[: len(array)] = array
    return grown


def _aligned(*shape: int) -> Float32[np.ndarray, "*shape"]:
    """An array that begins where a line of the cache does; elsewhere every other load would touch two lines."""
    line = 64
    raw = np.empty(4 * int(np.prod(shape)) + line, np.uint8)
    first = -raw.ctypes.data % line
    return raw[first : len(raw) - line + first].view(np.float32).reshape(shape)
