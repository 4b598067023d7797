"""A localizer that compares frames through any encoder."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from vprbench.protocols import Encoder, Recruiting
from vprbench.types import Landmarks, Observation, Responses


class NearestView:
    """A place keeps its landmarks; it responds as the mean best match of the frame's landmarks to them."""

    recruiting: ClassVar[Recruiting] = "vigilance"

    def __init__(self, encoder: Encoder, floor: float = 0.0) -> None:
        self.encoder, self.floor = encoder, floor
        self.clear(1.0)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Train the encoder on every frame."""
        self.encoder.fit([observation["frame"] for drive in drives for observation in drive])

    def clear(self, sampling: float) -> None:
        """Forget every place; `sampling` is the vigilance from now on."""
        self.vigilance = sampling
        self.places: list[Landmarks] = []

    def learn(self, observation: Observation) -> int | None:
        """Recruit where no place responds as much as the vigilance."""
        if self.places and self.respond(observation).max() >= self.vigilance:
            return None
        self.places.append(self.encoder.encode(observation["frame"]))
        return len(self.places) - 1

    def respond(self, observation: Observation) -> Responses:
        """Mean best match, place by place."""
        seen = self.encoder.encode(observation["frame"]).signatures
        best = [self.encoder.match(seen, place.signatures).max(axis=1, initial=0).sum() for place in self.places]
        return np.asarray(np.clip(np.array(best) / max(len(seen), 1) - self.floor, 0, 1), np.float32)
