"""The memory that suits an encoder, in segments, so that what a query works on at a time stays in the cache."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Protocol

import numpy as np

from vprbench.protocols import Encoder
from vprbench.types import Responses
from vprbench_localizers.matching import OverlapEncoder, SketchingEncoder
from vprbench_localizers.overlap_memory import OverlapMemory
from vprbench_localizers.pair_memory import PairMemory
from vprbench_localizers.sketch_memory import SketchMemory
from vprbench_localizers.unit_activity import Rule, View

__all__ = ["Memory", "SegmentedMemory", "memory_for"]

# Places of a segment (our choice): the units of so many, with all that is noted of them, fit in 2 MB.
PLACES = 2048


def memory_for(encoder: Encoder) -> SegmentedMemory:
    """An empty memory, of the fastest kind that an encoder allows."""
    return SegmentedMemory(partial(_segment, encoder))


def _segment(encoder: Encoder) -> Memory:
    if isinstance(encoder, OverlapEncoder) and encoder.matches_by_overlap:
        return OverlapMemory(PLACES)
    if isinstance(encoder, SketchingEncoder) and encoder.matches_by_sketch:
        return SketchMemory(encoder)
    return PairMemory(encoder)


class Memory(Protocol):
    """Places that are stored one after another, and respond together."""

    def __len__(self) -> int:
        """How many places there are."""
        ...

    def add(self, view: View) -> int:
        """Store a place; its index. A place without landmarks has no unit.

        Raises:
            PluginError: its signatures are of another size than those stored.
        """
        ...

    def respond(self, query: View, rule: Rule) -> Responses:
        """Response 0..1 of every place."""
        ...


class SegmentedMemory:
    """A memory of many: adding a place touches the last only, and nothing is copied once its segment is full.

    Args:
        make: an empty segment.
        places: of a segment; the responses do not depend on it.
    """

    def __init__(self, make: Callable[[], Memory], places: int = PLACES) -> None:
        self._make, self._places = make, places
        self._segments: list[Memory] = []

    def __len__(self) -> int:
        return sum(map(len, self._segments))

    def add(self, view: View) -> int:
        """Store a place; its index."""
        if not self._segments or len(self._segments[-1]) == self._places:
            self._segments.append(self._make())
        return self._places * (len(self._segments) - 1) + self._segments[-1].add(view)

    def respond(self, query: View, rule: Rule) -> Responses:
        """Response 0..1 of every place."""
        if not self._segments:
            return np.zeros(0, np.float32)
        return np.concatenate([segment.respond(query, rule) for segment in self._segments])
