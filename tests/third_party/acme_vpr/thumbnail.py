"""A localizer that keeps a thumbnail a place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from vprbench.protocols import Recruiting
from vprbench.types import Observation, Responses

Thumb = npt.NDArray[np.float32]


class Thumbnail:
    """A place is a small picture; it responds as one minus the mean difference.

    Args:
        shrink: how many pixels, along each side, become one.
        gain: how steeply the response falls.
    """

    recruiting: ClassVar[Recruiting] = "step"

    def __init__(self, shrink: int = 16, gain: float = 1.0) -> None:
        self.shrink, self.gain = shrink, gain
        self.clear(1.0)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Nothing to learn."""

    def clear(self, sampling: float) -> None:
        """Forget every place; recruit each `sampling` metres from now on."""
        self.step = sampling
        self.places: list[Thumb] = []
        self.since = 0.0
        self.last: npt.NDArray[np.float64] | None = None

    def learn(self, observation: Observation) -> int | None:
        """Recruit where the distance driven since the last place reaches the step."""
        here = observation["gps"].copy()
        self.since += 0.0 if self.last is None else float(np.linalg.norm(here - self.last))
        self.last = here
        if self.places and self.since < self.step:
            return None
        self.since = 0.0
        self.places.append(self.describe(observation))
        return len(self.places) - 1

    def respond(self, observation: Observation) -> Responses:
        """How alike each place's thumbnail is."""
        return self.compare([self.describe(observation)], self.places)[0]

    def describe(self, observation: Observation) -> Thumb:
        """The frame, shrunk."""
        small = observation["frame"][:: self.shrink, :: self.shrink]
        return np.asarray(small / 255, np.float32)

    def compare(self, queries: Sequence[Thumb], places: Sequence[Thumb]) -> npt.NDArray[np.float32]:
        """One minus the mean difference of each pair."""
        away = [[float(np.abs(q - p).mean()) * self.gain for p in places] for q in queries]
        return np.asarray(np.clip(1 - np.array(away).reshape(len(queries), len(places)), 0, 1), np.float32)
