"""Local views: the disks of an image that stand around focus points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32

__all__ = ["LocalView", "jittered"]


@dataclass(frozen=True)
class LocalView:
    """The disk around a focus point at half resolution, as a vector with its mean removed (our choice).

    Attributes:
        window: width of the view in the whole frame, px; half as many in the halved image.
    """

    window: int = 54

    @property
    def side(self) -> int:
        """Rows and columns of the view in the halved image."""
        return self.window // 2

    @cached_property
    def disk(self) -> Bool[np.ndarray, "side side"]:
        """Which pixels of the square lie within half its width of its centre."""
        offset = np.arange(self.side) - (self.side - 1) / 2
        return np.hypot(offset[:, None], offset) <= self.side / 2

    @cached_property
    def size(self) -> int:
        """How many pixels the disk has."""
        return int(self.disk.sum())

    def cut(
        self, image: Float32[np.ndarray, "rows columns"], points: Float32[np.ndarray, "points 2"]
    ) -> Float32[np.ndarray, "points size"]:
        """The view around each point (u, v) of the frame that `image` is the half of.

        A view that would leave the image is cut at its nearest place within.
        """
        height, width = image.shape
        corner = (points // 2).astype(np.int64) - self.side // 2
        left, top = np.clip(corner, 0, [width - self.side, height - self.side]).T
        rows, columns = np.nonzero(self.disk)
        # Pixel by pixel of all views.
        views = image.ravel().take((rows * width + columns)[:, None] + (top * width + left)).T
        return views - views.mean(axis=1, keepdims=True)

    def picture(self, views: Float32[np.ndarray, "n size"]) -> Float32[np.ndarray, "n side side"]:
        """Views or atoms as squares to look at, zero outside the disk."""
        squares = np.zeros((len(views), self.side, self.side), np.float32)
        squares[:, self.disk] = views
        return squares


def jittered(
    points: Float32[np.ndarray, "points 2"], reach: int, copies: int, random: np.random.Generator
) -> Float32[np.ndarray, "copies_points 2"]:
    """Every point `copies` times: once where it is, then moved by up to `reach` px along each axis."""
    shifts = random.integers(-reach, reach, (copies, *points.shape), endpoint=True)
    shifts[0] = 0
    return (points + shifts).reshape(-1, 2).astype(np.float32)
