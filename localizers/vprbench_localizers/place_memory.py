"""The regions of every learned place, in contiguous arrays that grow."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Self

import numpy as np
from jaxtyping import Float32

from vprbench_localizers.growing import Growing
from vprbench_localizers.place_search import OUTLINE_SIZE, outline
from vprbench_localizers.region_match import PLANES_SHAPE

__all__ = ["PlaceMemory"]


class PlaceMemory:
    """Places one after another; adding one costs the same however many there are."""

    def __init__(self) -> None:
        self._planes = Growing(np.float32, *PLANES_SHAPE)
        self._outlines = Growing(np.float32, OUTLINE_SIZE)

    @classmethod
    def of(cls, places: Iterable[Float32[np.ndarray, "32 288"]]) -> Self:
        """A memory of these places."""
        memory = cls()
        for planes in places:
            memory.add(planes)
        return memory

    @property
    def planes(self) -> Float32[np.ndarray, "places 32 288"]:
        """The planes of each place; a view that the next `add` may leave behind."""
        return self._planes.rows

    @property
    def outlines(self) -> Float32[np.ndarray, "places 128"]:
        """The outline of each place; a view that the next `add` may leave behind."""
        return self._outlines.rows

    def __len__(self) -> int:
        return len(self._planes)

    def add(self, planes: Float32[np.ndarray, "32 288"]) -> int:
        """Store a place; its index."""
        self._planes.extend(planes[None])
        self._outlines.extend(outline(planes)[None])
        return len(self) - 1
