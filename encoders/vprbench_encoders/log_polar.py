"""Log-polar signatures: the gradient around each focus point, sampled finely near it and coarsely far away."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from jaxtyping import Float32, Int64, UInt8
from numba import njit
from numpy.typing import NDArray

from vprbench.errors import ConfigError
from vprbench.types import Frame, Landmarks
from vprbench_encoders.focus import FocusDetector
from vprbench_encoders.l1 import mean_l1, mean_l1_pairs

__all__ = [
    "LogPolar",
    "area_average",
    "log_polar_6",
    "log_polar_9",
    "log_polar_12",
    "log_polar_15",
    "log_polar_27",
    "log_polar_grid",
    "sample_log_polar",
]

# Samples along the log-radius and along the angle: 54 x 54 = 2916 values, as in the paper.
SAMPLES = 54

# Rows and columns of a sketch (our choice). A map changes little from one radius to the next: on KITTI, sketches of a
# map in 162 values leave 11 % of LPMP's pairs to be compared in full, so as to find the best of each unit.
SKETCH = 6, 27

# Far above what rounding can do to a mean of differences of values in 0..1: below 2e-4 for maps of 54 x 54.
ROUNDING = 1e-3


def log_polar_grid(inner: float, outer: float) -> Float32[np.ndarray, "2 samples"]:
    """Offsets (du, dv) of the samples from the centre, px; row-major over log-radius, then angle.

    Row i lies at radius inner (outer / inner)^(i / 53); column j at 2 pi j / 54, turning from +u towards +v.
    """
    radius = np.geomspace(inner, outer, SAMPLES)[:, None]
    angle = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)]).reshape(2, -1).astype(np.float32)


@njit(cache=True)
def _sample(image: NDArray[np.float32], points: NDArray[np.float32], grid: NDArray[np.float32]) -> NDArray[np.float32]:
    samples = grid.shape[1]
    values = np.empty((len(points), samples), np.float32)
    corner, along, down = np.empty(samples, np.int32), np.empty(samples, np.float32), np.empty(samples, np.float32)
    for point in range(len(points)):
        _locate(image.shape, points[point], grid[0], grid[1], corner, along, down)
        _interpolate(image.ravel(), image.shape[1], corner, along, down, values[point])
    return values


# Where to read and what to make of it are two loops, since only the first can run in vector lanes.
@njit(cache=True)
def _locate(
    shape: tuple[int, int],
    point: NDArray[np.float32],
    du: NDArray[np.float32],
    dv: NDArray[np.float32],
    corner: NDArray[np.int32],
    along: NDArray[np.float32],
    down: NDArray[np.float32],
) -> None:
    """Flat index of the pixel up left of each sample, and how far beyond it the sample lies, 0..1."""
    width, right, bottom = np.int32(shape[1]), np.float32(shape[1] - 1), np.float32(shape[0] - 1)
    last_left, last_top, zero = np.int32(shape[1] - 2), np.int32(shape[0] - 2), np.float32(0)
    for i in range(len(du)):
        u = min(max(point[0] + du[i], zero), right)
        v = min(max(point[1] + dv[i], zero), bottom)
        left, top = min(np.int32(u), last_left), min(np.int32(v), last_top)
        along[i], down[i] = u - np.float32(left), v - np.float32(top)
        corner[i] = top * width + left


@njit(cache=True)
def _interpolate(
    pixels: NDArray[np.float32],
    width: int,
    corner: NDArray[np.int32],
    along: NDArray[np.float32],
    down: NDArray[np.float32],
    values: NDArray[np.float32],
) -> None:
    one = np.float32(1)
    right, below, opposite = pixels[1:], pixels[width:], pixels[width + 1 :]
    for i in range(len(values)):
        at = np.uint32(corner[i])
        upper = (one - along[i]) * pixels[at] + along[i] * right[at]
        lower = (one - along[i]) * below[at] + along[i] * opposite[at]
        values[i] = (one - down[i]) * upper + down[i] * lower


def sample_log_polar(
    image: Float32[np.ndarray, "height width"],
    points: Float32[np.ndarray, "points 2"],
    grid: Float32[np.ndarray, "2 samples"],
) -> Float32[np.ndarray, "points samples"]:
    """The image at every offset of the grid from every point (u, v), bilinear, the border repeated outwards."""
    return _sample(image, points, grid)


def area_average(size: int) -> Float32[np.ndarray, "size 54"]:
    """Weights that average 54 samples into `size` cells of equal width; a sample cut by an edge counts in part."""
    edges = np.linspace(0, SAMPLES, size + 1)
    low, high = edges[:-1, None], edges[1:, None]
    sample = np.arange(SAMPLES)
    overlap = np.clip(np.minimum(high, sample + 1) - np.maximum(low, sample), 0, None)
    return (overlap * size / SAMPLES).astype(np.float32)


class LogPolar:
    """The LPMP signature: a log-polar map of the gradient around each focus point, scaled to 0..1.

    Nothing is learned. With `size` below 54 the same map is area-averaged to size x size: the control that tells
    what compression alone buys. Alike = 1 - mean |x - w|. Pairs of maps of bytes, 255ths of 1, are compared too.

    Args:
        size: rows and columns of the signature, 1..54; 54 is the paper's.
        inner_radius: of the first row, px (our choice).
        outer_radius: of the last row, px (our choice).
        alpha, sigmas, points, radius, margin, floor: of the focus points; see `FocusDetector`.
    """

    matches_bytes = True

    def __init__(
        self,
        *,
        size: int = SAMPLES,
        inner_radius: float = 2.0,
        outer_radius: float = 27.0,
        alpha: float = 1.0,
        sigmas: tuple[float, float] = (2.0, 4.0),
        points: int = 25,
        radius: float = 20.0,
        margin: int = 27,
        floor: float = 1e-3,
    ) -> None:
        if not 1 <= size <= SAMPLES:
            raise ConfigError(f"log-polar: size must be 1..{SAMPLES}, not {size}")
        if not 0 < inner_radius < outer_radius:
            raise ConfigError(f"log-polar: radii must rise from above 0, not {inner_radius}, {outer_radius}")
        self.size = size
        self.focus = FocusDetector(alpha=alpha, sigmas=sigmas, points=points, radius=radius, margin=margin, floor=floor)
        self._grid = log_polar_grid(inner_radius, outer_radius)
        self._weights = area_average(size)
        self._sketch_weights = area_average(SKETCH[0]), area_average(SKETCH[1])

    def fit(self, frames: Sequence[Frame]) -> None:
        """Do nothing: a log-polar map is not learned."""

    def encode(self, frame: Frame) -> Landmarks:
        """The log-polar maps of the frame's focus points, each divided by its own maximum (our choice)."""
        gradient = self.focus.gradient(frame)
        points = self.focus.find(gradient)
        maps = sample_log_polar(gradient, points, self._grid)
        maps /= maps.max(axis=1, keepdims=True, initial=np.finfo(np.float32).tiny)
        return Landmarks(self._shrink(maps), points)

    def match(
        self, queries: Float32[np.ndarray, "points size"], memory: Float32[np.ndarray, "units size"]
    ) -> Float32[np.ndarray, "points units"]:
        """How alike every query is to every stored signature: 1 - mean |x - w|."""
        return np.float32(1) - mean_l1(queries, memory)

    def match_pairs(
        self,
        queries: Float32[np.ndarray, "points size"] | UInt8[np.ndarray, "points size"],
        memory: Float32[np.ndarray, "units size"] | UInt8[np.ndarray, "units size"],
        query_index: Int64[np.ndarray, " pairs"],
        memory_index: Int64[np.ndarray, " pairs"],
    ) -> Float32[np.ndarray, " pairs"]:
        """The same as `match`, for chosen pairs only."""
        return np.float32(1) - mean_l1_pairs(queries, memory, query_index, memory_index)

    @property
    def matches_by_sketch(self) -> bool:
        """Whether maps are so large that comparing smaller ones first is worth it."""
        return self.size == SAMPLES

    def sketch(
        self, signatures: Float32[np.ndarray, "rows 2916"] | UInt8[np.ndarray, "rows 2916"]
    ) -> Float32[np.ndarray, "rows 162"]:
        """The maps, averaged over areas: they differ by no more than what they are the means of."""
        rows, columns = self._sketch_weights
        values = signatures / np.float32(255) if signatures.dtype == np.uint8 else signatures
        maps = values.reshape(len(values), SAMPLES, SAMPLES)
        return (rows @ maps @ columns.T).reshape(len(maps), rows.shape[0] * columns.shape[0])

    def match_at_most(
        self,
        queries: Float32[np.ndarray, "points 162"],
        memory: Float32[np.ndarray, "units 162"],
        query_index: Int64[np.ndarray, " pairs"],
        memory_index: Int64[np.ndarray, " pairs"],
    ) -> Float32[np.ndarray, " pairs"]:
        """Of pairs of sketches, matches that `match_pairs` does not exceed."""
        return np.float32(1 + ROUNDING) - mean_l1_pairs(queries, memory, query_index, memory_index)

    def _shrink(self, maps: Float32[np.ndarray, "points 2916"]) -> Float32[np.ndarray, "points size2"]:
        if self.size == SAMPLES:
            return maps
        square = maps.reshape(-1, SAMPLES, SAMPLES)
        return (self._weights @ square @ self._weights.T).reshape(len(maps), self.size**2)


log_polar_27 = partial(LogPolar, size=27)
log_polar_15 = partial(LogPolar, size=15)
log_polar_12 = partial(LogPolar, size=12)
log_polar_9 = partial(LogPolar, size=9)
log_polar_6 = partial(LogPolar, size=6)
