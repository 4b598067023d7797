"""The frame x frame response matrix: what every frame of the learn drive, made a place, answers to every frame.

A place's response does not depend on which other places exist, so each column is computed once and serves every
vigilance, every sampling distance, and the record and test phases.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Generic, TypeVar

import numpy as np
from jaxtyping import Float32, Int64

from vprbench.episode import Recording, winners
from vprbench.observation import Drive
from vprbench.protocols import DescriptorLocalizer
from vprbench.recruiting import Odometer, bisect_vigilance, recruit_by_vigilance
from vprbench.reporting import Report, silent
from vprbench.route import Route

__all__ = ["ResponseMatrix"]

Description = TypeVar("Description")

# Columns computed at once: enough to spread the cost of a call, few enough to report progress.
BLOCK = 16


class ResponseMatrix(Generic[Description]):
    """All that one fitted localizer answers on one route, described once and compared when asked for."""

    def __init__(self, route: Route, localizer: DescriptorLocalizer[Description], report: Report = silent) -> None:
        self.route = route
        self.localizer = localizer
        self.report = report
        self._frames = len(route.learn)
        self._descriptions = self._describe()
        self._columns = np.empty((len(self._descriptions), self._frames), np.float32)
        self._known = np.zeros(self._frames, bool)

    def sampling(self, sampling_distance: float) -> float:
        """The vigilance or step that gives a place every `sampling_distance` metres on average."""
        if self.localizer.recruiting == "step":
            return sampling_distance
        target = self.route.learn.length / sampling_distance
        return bisect_vigilance(lambda vigilance: len(self.place_frames(vigilance)), target)

    def place_frames(self, sampling: float) -> Int64[np.ndarray, " places"]:
        """The learn frames that become places at this vigilance or step."""
        if self.localizer.recruiting == "step":
            odometer = Odometer(sampling)
            due = [odometer.due(position) for position in self.route.learn.positions]
            return np.flatnonzero(due)
        return np.fromiter(recruit_by_vigilance(self._column, self._frames, sampling), np.int64)

    def recording(self, sampling: float) -> Recording:
        """What the localizer answers in the three phases at this vigilance or step."""
        places = self.place_frames(sampling)
        self._compute(places)
        block = self._columns[:, places]
        return Recording(places, winners(block[: self._frames]), block[self._frames :])

    def _describe(self) -> list[Description]:
        """Descriptions of the learn frames, then of the test frames; neither shows GPS."""
        drives = (Drive(self.route.learn, gps=False), Drive(self.route.test, gps=False))
        total = sum(len(drive) for drive in drives)
        described: list[Description] = []
        for observation in (observation for drive in drives for observation in drive):
            described.append(self.localizer.describe(observation))
            self.report("describe frames", len(described), total)
        return described

    def _column(self, frame: int) -> Float32[np.ndarray, " frames"]:
        """Response of a place made at a learn frame to every learn frame."""
        if not self._known[frame]:
            # A vigilance loop goes through most frames in the end, so the following ones are done with it.
            self._compute(np.arange(frame, min(frame + BLOCK, self._frames)))
        return self._columns[: self._frames, frame]

    def _compute(self, frames: Int64[np.ndarray, " wanted"]) -> None:
        """Fill in those of the wanted columns that are not yet known."""
        missing = frames[~self._known[frames]]
        for start in range(0, len(missing), BLOCK):
            block = missing[start : start + BLOCK]
            self._columns[:, block] = self.localizer.compare(self._descriptions, self._pick(block))
            self._known[block] = True
            self.report("compare frames", int(self._known.sum()), self._frames)

    def _pick(self, frames: Int64[np.ndarray, " wanted"]) -> Sequence[Any]:
        """Descriptions of some learn frames."""
        return [self._descriptions[frame] for frame in frames]
