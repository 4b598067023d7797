"""A memory in segments of so many places, so that what a query works on at a time stays in the cache."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from vprbench.types import Responses
from vprbench_localizers.unit_activity import Rule, View

__all__ = ["Memory", "SegmentedMemory"]

# Places of a segment (our choice): the units of so many, with all that is noted of them, fit in 2 MB.
PLACES = 2048


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
