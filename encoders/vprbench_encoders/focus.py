"""Focus points: the pixels of a frame that are worth a local view.

The saliency map is a difference of Gaussians of the Deriche gradient (Espada et al., 2019, as the paper uses it);
its local maxima, strongest first, become focus points unless they stand too near to a stronger one.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float32
from numba import njit
from numpy.typing import NDArray

from vprbench.errors import ConfigError, DataError
from vprbench.types import Frame
from vprbench_encoders.deriche import gradient_magnitude

__all__ = ["FocusDetector"]


@njit(cache=True)
def _local_maxima(saliency: NDArray[np.float32], margin: int, floor: np.float32) -> NDArray[np.int64]:
    """Flat indices, in reading order, of pixels above `floor` that none of their eight neighbours exceeds."""
    rows, columns = saliency.shape
    found = []
    for v in range(margin, rows - margin):
        above, level, below = saliency[v - 1], saliency[v], saliency[v + 1]
        for u in range(margin, columns - margin):
            here = level[u]
            if here > floor and here >= level[u - 1] and here >= level[u + 1]:
                highest = max(above[u - 1], above[u], above[u + 1], below[u - 1], below[u], below[u + 1])
                if here >= highest:
                    found.append(v * columns + u)
    return np.array(found, np.int64)


@njit(cache=True)
def _compete(candidates: NDArray[np.float32], radius: np.float32, points: int) -> NDArray[np.float32]:
    """The first `points` candidates (u, v) that lie at least `radius` from every one kept before them."""
    kept = np.empty((points, 2), np.float32)
    count = 0
    for u, v in candidates:
        free = count < points
        for k in range(count):
            free = free and (kept[k, 0] - u) ** 2 + (kept[k, 1] - v) ** 2 >= radius * radius
        if free:
            kept[count] = u, v
            count += 1
    return kept[:count]


@dataclass(frozen=True, kw_only=True)
class FocusDetector:
    """Finds the focus points of a frame; every default is our choice, as the paper gives none.

    Attributes:
        alpha: inverse width of the Deriche filter, 1/px.
        sigmas: of the inner and the outer Gaussian, px.
        points: at most so many focus points a frame.
        radius: least distance between two of them, px.
        margin: least distance to the frame's border, px, so that a whole local view fits.
        floor: least saliency, grey levels a pixel; a lone pixel one grey level off its surroundings has 0.008
            at the other defaults, so below are only rounding errors.
    """

    alpha: float = 1.0
    sigmas: tuple[float, float] = (2.0, 4.0)
    points: int = 25
    radius: float = 20.0
    margin: int = 27
    floor: float = 1e-3

    def __post_init__(self) -> None:
        """Refuse values with which no point could be found."""
        inner, outer = self.sigmas
        if not 0 < inner < outer:
            raise ConfigError(f"focus points: sigmas must rise from above 0, not {inner}, {outer}")
        for name, least in (("alpha", 0.01), ("points", 1), ("radius", 0), ("margin", 1), ("floor", 0)):
            if not getattr(self, name) >= least:
                raise ConfigError(f"focus points: {name} must be at least {least}, not {getattr(self, name)}")

    def gradient(self, frame: Frame) -> Float32[np.ndarray, "height width"]:
        """The image in which points are sought, and from which local views may be cut.

        Raises:
            DataError: this is no grey frame.
        """
        if frame.dtype != np.uint8 or frame.ndim != 2 or min(frame.shape) < 2:
            raise DataError(f"a frame is a grey uint8 image (height, width), not {frame.dtype} {frame.shape}")
        return gradient_magnitude(frame, self.alpha)

    def saliency(self, gradient: Float32[np.ndarray, "height width"]) -> Float32[np.ndarray, "height width"]:
        """How much more gradient there is near each pixel than around it."""
        inner, outer = (cv2.GaussianBlur(gradient, (0, 0), sigma) for sigma in self.sigmas)
        return cv2.subtract(inner, outer)

    def find(self, gradient: Float32[np.ndarray, "height width"]) -> Float32[np.ndarray, "points 2"]:
        """Column u and row v of every focus point, the most salient first; equals in reading order.

        A frame without any gradient has none.
        """
        saliency = self.saliency(gradient)
        maxima = _local_maxima(saliency, self.margin, np.float32(self.floor))
        strongest = maxima[np.argsort(-saliency.ravel()[maxima], kind="stable")]
        v, u = np.divmod(strongest, gradient.shape[1])
        return _compete(np.stack([u, v], axis=1).astype(np.float32), np.float32(self.radius), self.points)
