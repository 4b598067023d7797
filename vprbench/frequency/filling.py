"""Observations to make any number of places of: the frames of a route's learn drive first, then others present."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from itertools import chain, islice
from typing import NamedTuple

import numpy as np

from vprbench.observation import Drive
from vprbench.reporting import Report, silent
from vprbench.route import Route
from vprbench.types import Observation

__all__ = ["Filled", "Filling", "told"]

# Where a frame comes from; "again" is any of them a second time.
SOURCES = ("learn", "training", "test", "again")


class Filled(NamedTuple):
    """One observation to learn from.

    Attributes:
        observation: to be learned.
        frame: number of its frame; equal numbers have equal frames.
        source: the kind of drive it comes from, one of `SOURCES`.
    """

    observation: Observation
    frame: int
    source: str


class Filling:
    """A road as long as is asked for: each observation is a metre on from the last, headed as the learn drive was.

    A route has fewer frames than memory is to hold places: those of its learn drive are followed by those of its
    training and test drives, and these by all of them again. Frames from elsewhere take on the headings of the learn
    drive, over and over. With their own, a localizer that looks for landmarks where the compass says could leave
    them aside, and a query would seem to cost the same however many there are.

    Args:
        route: whose frames are taken; they are read at once and kept.
        frames: at most so many are needed.
        report: is told how many are read.
    """

    def __init__(self, route: Route, frames: int, report: Report = silent) -> None:
        drives = [("learn", route.learn), *(("training", drive) for drive in route.training), ("test", route.test)]
        found = chain.from_iterable(((source, seen) for seen in Drive(drive)) for source, drive in drives)
        total = min(frames, sum(len(drive) for _, drive in drives))
        self._seen: list[tuple[str, Observation]] = []
        for entry in islice(found, total):
            self._seen.append(entry)
            report("read frames", len(self._seen), total)
        self._headings = route.learn.headings

    def __len__(self) -> int:
        """How many different frames there are."""
        return len(self._seen)

    def __getitem__(self, index: int) -> Filled:
        """The observation at a metre of the road, from 0 on without end."""
        frame = index % len(self._seen)
        source, seen = self._seen[frame]
        observation = Observation(frame=seen["frame"], camera=seen["camera"], gps=np.array([0.0, index], np.float64))
        if "heading" in seen:
            observation["heading"] = self._headings[[index % len(self._headings)]].astype(np.float64)
        return Filled(observation, frame, source if index < len(self._seen) else "again")


def told(sources: Iterable[str]) -> str:
    """Where frames come from, in words: "learn 93, training 7"."""
    counted = Counter(sources)
    return ", ".join(f"{source} {counted[source]}" for source in SOURCES if counted[source])
