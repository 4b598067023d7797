"""An encoder that learns, and offers all that is optional."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Self

import numpy as np

from vprbench.types import Frame, Landmarks, LearningStep

from .mean_patch import MeanPatch

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Typical(MeanPatch):
    """A MeanPatch whose values count the less, the brighter they typically are.

    Whenever it learns, it says so in the file that ACME_FITS names, if any.

    Args:
        seed: of the weights that it starts from.
        size: see `MeanPatch`.
    """

    def __init__(self, seed: int, size: int = 4) -> None:
        super().__init__(size)
        self.seed, self.seconds = seed, 0.0
        self.weights = np.random.default_rng(seed).uniform(0.9, 1.0, size * size).astype(np.float32)

    def fit(self, frames: Sequence[Frame]) -> None:
        """Learn from every frame."""
        for _ in self.learning(frames):
            pass

    def learning(self, frames: Sequence[Frame]) -> Iterator[LearningStep]:
        """Learn from a frame at each step."""
        started = perf_counter()
        if log := os.environ.get("ACME_FITS"):
            with Path(log).open("a") as file:
                file.write(f"{self.seed}\n")
        means = []
        for number in range(len(frames)):
            means.append(super().encode(frames[number]).signatures.mean(axis=0))
            yield LearningStep("brightness", number + 1, len(frames), f"mean {means[-1].mean():.2f}")
        self.weights *= 1 - np.mean(means, axis=0, dtype=np.float32) / 2
        self.seconds = perf_counter() - started

    def encode(self, frame: Frame) -> Landmarks:
        """The weighted brightness of every cell's parts."""
        signatures, points = super().encode(frame)
        return Landmarks(signatures * self.weights, points)

    def save(self, path: Path) -> None:
        """Write the weights."""
        with path.open("wb") as file:
            np.savez(file, weights=self.weights, seed=self.seed, seconds=self.seconds)

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read them."""
        with path.open("rb") as file, np.load(file) as stored:
            weights, seed, seconds = stored["weights"], int(stored["seed"]), float(stored["seconds"])
        encoder = cls(seed, size=round(weights.size**0.5))
        encoder.weights, encoder.seconds = weights, seconds
        return encoder

    def measures(self) -> Mapping[str, float]:
        """Mean and spread of the weights."""
        return {
            "weight": float(self.weights.mean()),
            "weight_held_out": float(self.weights.std()),
            "weight_seconds": self.seconds,
        }

    def figures(self) -> Mapping[str, Figure]:
        """The weights as a picture."""
        from matplotlib.figure import Figure

        figure = Figure()
        figure.add_subplot().imshow(self.weights.reshape(self.size, self.size))
        return {"weights": figure}
