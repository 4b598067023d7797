"""A localizer that compares frames through any encoder."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from vprbench.protocols import Encoder, Recruiting
from vprbench.types import Landmarks, Observation, Responses


class NearestView:
    """A place keeps its landmarks; it responds as the mean best match of the frame's landmarks to them."""

    recruiting: ClassVar[Recruiting] = "vigilance"

    def __init__(self, encoder: Encoder, floor: float = 0.0) -> None:
        self.encoder, self.floor = encoder, floor
        self.clear(1.0)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Nothing of its own to learn."""

    def clear(self, sampling: float) -> None:
        """Forget every place; `sampling` is the vigilance from now on."""
        self.vigilance = sampling
        self.places: list[Landmarks] = []

    def learn(self, observation: Observation) -> int | None:
        """Recruit where no place responds as much as the vigilance."""
        if self.places and self.respond(observation).max() >= self.vigilance:
            return None
        self.places.append(self.describe(observation))
        return len(self.places) - 1

    def respond(self, observation: Observation) -> Responses:
        """Mean best match, place by place."""
        return self.compare([self.describe(observation)], self.places)[0]

    def describe(self, observation: Observation) -> Landmarks:
        """The landmarks."""
        return self.encoder.encode(observation["frame"])

    def compare(self, queries: Sequence[Landmarks], places: Sequence[Landmarks]) -> npt.NDArray[np.float32]:
        """Mean best match of each pair."""
        responses = np.zeros((len(queries), len(places)), np.float32)
        for row, column in np.ndindex(responses.shape):
            seen = queries[row].signatures
            best = self.encoder.match(seen, places[column].signatures).max(axis=1, initial=0)
            responses[row, column] = np.clip(best.sum() / max(len(seen), 1) - self.floor, 0, 1)
        return responses
