"""A localizer that keeps a thumbnail a place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from vprbench.protocols import Recruiting
from vprbench.types import Frame, Observation, Responses

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
        self.places.append(self._shrink(observation["frame"]))
        return len(self.places) - 1

    def respond(self, observation: Observation) -> Responses:
        """One minus the mean difference from each place's thumbnail."""
        seen = self._shrink(observation["frame"])
        away = [float(np.abs(seen - place).mean()) * self.gain for place in self.places]
        return np.asarray(np.clip(1 - np.array(away), 0, 1), np.float32)

    def _shrink(self, frame: Frame) -> Thumb:
        return np.divide(frame[:: self.shrink, :: self.shrink], 255, dtype=np.float32)
