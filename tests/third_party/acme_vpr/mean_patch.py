"""An encoder that looks at fixed patches and keeps their coarse brightness."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Literal

import numpy as np
import numpy.typing as npt

from vprbench.types import Frame, Landmarks


class MeanPatch:
    """Each cell of a coarse grid is a landmark, described by the mean brightness of its parts.

    Args:
        size: side of the signature: a cell gives size * size values.
        grid: cells a frame, rows and columns.
        metric: "l1" or "l2" distance between signatures.
        darkness: brightness below which a value counts as zero.
    """

    def __init__(
        self,
        size: int = 4,
        grid: tuple[int, int] = (2, 6),
        metric: Literal["l1", "l2"] = "l1",
        darkness: float | None = None,
    ) -> None:
        if size < 1:
            raise ValueError(f"size must be at least 1, not {size}")
        self.size, self.grid, self.metric, self.darkness = size, grid, metric, darkness

    def fit(self, frames: Sequence[Frame]) -> None:
        """Nothing to learn."""

    def encode(self, frame: Frame) -> Landmarks:
        """The mean brightness of every cell's parts, 0..1."""
        (rows, columns), size = self.grid, self.size
        height, width = frame.shape[0] // (rows * size), frame.shape[1] // (columns * size)
        parts = frame[: rows * size * height, : columns * size * width]
        means = parts.reshape(rows, size, height, columns, size, width).mean(axis=(2, 5)) / 255.0
        means[means < (self.darkness or 0.0)] = 0.0
        signatures = means.transpose(0, 2, 1, 3).reshape(rows * columns, size * size)
        v, u = np.indices((rows, columns)).reshape(2, -1) + 0.5
        points = np.stack([u * size * width, v * size * height], axis=1)
        return Landmarks(signatures.astype(np.float32), points.astype(np.float32))

    def match(self, queries: npt.NDArray[np.float32], memory: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """One minus the mean distance."""
        power = 1 if self.metric == "l1" else 2
        away = np.abs(queries[:, None, :] - memory[None, :, :]) ** power
        return np.asarray(1.0 - away.mean(axis=2) ** (1 / power), np.float32)


fine_patch = partial(MeanPatch, size=8)


def noisy_patch(seed: int, size: int = 4) -> MeanPatch:
    """A MeanPatch of random grid, to have something seeded."""
    rows, columns = np.random.default_rng(seed).integers(1, 5, size=2).tolist()
    return MeanPatch(size, grid=(rows, columns))
