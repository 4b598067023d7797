"""When a new place is recruited: after a step of road, or when no place responds to the frame well enough."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float32, Float64

__all__ = ["Odometer", "bisect_vigilance", "recruit_by_vigilance"]

# 24 halvings of 0..1 resolve a vigilance finer than the step between two float32 responses near 1.
HALVINGS = 24


@dataclass
class Odometer:
    """Measures the road since the last place, from one GPS position to the next.

    Attributes:
        step: road between two places, metres.
    """

    step: float
    _last: Float64[np.ndarray, "2"] | None = field(default=None, init=False)
    _travelled: float = field(default=0.0, init=False)

    def due(self, position: Float64[np.ndarray, "2"]) -> bool:
        """Whether a place is due here; if it is, the count starts again."""
        first = self._last is None
        if self._last is not None:
            self._travelled += float(np.linalg.norm(position - self._last))
        self._last = np.array(position, np.float64)
        if first or self._travelled >= self.step:
            self._travelled = 0.0
            return True
        return False


def recruit_by_vigilance(
    column: Callable[[int], Float32[np.ndarray, " frames"]], frames: int, vigilance: float
) -> Iterator[int]:
    """Frames at which the vigilance loop recruits: where the best response so far is below the vigilance.

    `column(k)` is the response of a place made at frame k to every frame of the drive. The first frame always
    recruits.
    """
    best = np.full(frames, -np.inf, np.float32)
    for frame in range(frames):
        if best[frame] < np.float32(vigilance):
            np.fmax(best, column(frame), out=best)
            yield frame


def bisect_vigilance(count: Callable[[float], int], target: float) -> float:
    """The vigilance at which `count(vigilance)` places comes nearest to `target`.

    More vigilance recruits more places, though not strictly so: the nearest count met on the way is kept. Of
    equally near ones the lower vigilance wins, so the answer does not depend on rounding.
    """
    low, high, tried = 0.0, 1.0, dict[float, int]()
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        tried[middle] = count(middle)
        if tried[middle] == round(target):
            break
        low, high = (middle, high) if tried[middle] < target else (low, middle)
    return min(tried, key=lambda vigilance: (abs(tried[vigilance] - target), vigilance))
