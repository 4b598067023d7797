"""Focus points: the pixels of a frame that are worth a local view.

The saliency map is a difference of Gaussians of the Deriche gradient (Espada et al., 2019, as the paper uses it);
its local maxima, strongest first, become focus points unless they stand too near to a stronger one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Float32, Int64
from numba import njit
from numpy.typing import NDArray

from vprbench.errors import ConfigError, DataError
from vprbench.types import Frame
from vprbench_encoders.deriche import gradient_magnitude
from vprbench_encoders.resolution import reduced

__all__ = ["FocusDetector"]


def _inside(image: Float32[np.ndarray, "height width"], margin: int) -> Float32[np.ndarray, "rows columns"]:
    """The part of an image that is at least `margin` from its border."""
    height, width = image.shape
    return image[margin : height - margin, margin : width - margin]


def _blurred(
    image: Float32[np.ndarray, "height width"], sigma: float, margin: int
) -> Float32[np.ndarray, "rows columns"]:
    """The image under a Gaussian, without its margin, of which no more is blurred than the kernel reaches."""
    reach = (round(8 * sigma + 1) | 1) // 2  # as OpenCV sizes the kernel
    unseen = max(margin - reach, 0)
    return _inside(cv2.GaussianBlur(_inside(image, unseen), (0, 0), sigma), margin - unseen)


def _local_maxima(saliency: Float32[np.ndarray, "height width"], floor: np.float32) -> Int64[np.ndarray, "2 maxima"]:
    """Row and column, from the second on, of pixels above `floor` that no neighbour exceeds; the highest first."""
    level = _inside(saliency, 1)
    marks = np.empty(level.shape, np.bool_)
    _mark_maxima(saliency, floor, marks)
    maxima = np.stack(np.divmod(np.flatnonzero(marks), level.shape[1]))
    return maxima[:, np.argsort(-level[*maxima], kind="stable")]


@njit(cache=True)
def _mark_maxima(saliency: NDArray[np.float32], floor: np.float32, marks: NDArray[np.bool_]) -> None:
    """Say of each pixel, from the second row and column on, whether it is one of the local maxima."""
    for i in range(marks.shape[0]):
        above, row, below = saliency[i], saliency[i + 1], saliency[i + 2]
        for j in range(marks.shape[1]):
            # By twos, so that a row of them goes through vector lanes.
            highest = max(
                max(max(above[j], above[j + 1]), max(above[j + 2], row[j])),
                max(max(row[j + 2], below[j]), max(below[j + 1], below[j + 2])),
            )
            marks[i, j] = (row[j + 1] >= highest) & (row[j + 1] > floor)


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


def _must_be_grey(frame: Frame) -> None:
    if frame.dtype != np.uint8 or frame.ndim != 2 or min(frame.shape) < 2:
        raise DataError(f"a frame is a grey uint8 image (height, width), not {frame.dtype} {frame.shape}")


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
        _must_be_grey(frame)
        return gradient_magnitude(frame, self.alpha)

    def saliency(
        self, gradient: Float32[np.ndarray, "height width"], margin: int = 0
    ) -> Float32[np.ndarray, "rows columns"]:
        """How much more gradient there is near each pixel than around it, but for a margin at the border."""
        inner, outer = (_blurred(gradient, sigma, margin) for sigma in self.sigmas)
        return cv2.subtract(inner, outer)

    def find(self, gradient: Float32[np.ndarray, "height width"]) -> Float32[np.ndarray, "points 2"]:
        """Column u and row v of every focus point, the most salient first; equals in reading order.

        A frame without any gradient has none.
        """
        if min(gradient.shape) <= 2 * self.margin:
            return np.empty((0, 2), np.float32)
        # The neighbours of the pixels on the margin are one pixel nearer to the border.
        v, u = _local_maxima(self.saliency(gradient, self.margin - 1), np.float32(self.floor)) + self.margin
        return _compete(np.stack([u, v], axis=1).astype(np.float32), np.float32(self.radius), self.points)

    def points_of(self, frame: Frame, reduction: int = 1) -> Float32[np.ndarray, "points 2"]:
        """The focus points of a frame, sought at 1/reduction of its resolution: coarser, and so much the quicker.

        Raises:
            DataError: this is no grey frame.
        """
        if reduction == 1:
            return self.find(self.gradient(frame))
        _must_be_grey(frame)
        coarse = self._at(reduction)
        points = coarse.find(coarse.gradient(reduced(frame, reduction)))
        # A pixel of the reduced frame stands in the middle of those that it is the mean of.
        return points * np.float32(reduction) + np.float32((reduction - 1) / 2)

    def _at(self, reduction: int) -> FocusDetector:
        """The detector of the same things in a frame of 1/reduction of the resolution."""
        inner, outer = self.sigmas
        return replace(
            self,
            alpha=self.alpha * reduction,
            sigmas=(inner / reduction, outer / reduction),
            radius=self.radius / reduction,
            margin=-(-self.margin // reduction),
        )
