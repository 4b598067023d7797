"""The filler: finds the pixels of one projected face that are still clear, and how much of each it covers."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.street.canvas import OPAQUE, Canvas, View
from vprbench.street.face import paint_face, plane_of
from vprbench.street.pixels import CAPACITY, Pixels
from vprbench.street.sunlight import Sunlight

__all__ = ["fill"]

# A face reaches this far beyond its edges, pixels: fading there, it meets its neighbour without a gap.
_RIM = 1.0


@njit(cache=True, error_model="numpy")
def fill(
    canvas: Canvas,
    pixels: Pixels,
    view: View,
    polygon: NDArray[np.float64],
    edges: NDArray[np.float64],
    corners: NDArray[np.float64],
    texels: NDArray[np.uint16],
    skin: NDArray[np.int64],
    surface: NDArray[np.float64],
    sunlight: Sunlight,
) -> None:
    """Paint one face.

    Args:
        canvas: what has been painted so far.
        pixels: room for a batch.
        view: the camera.
        polygon: (n, 3) the face's corners in the picture, pixels.
        edges: (n, 3) a, b, c of its edges, a x + b y + c being the pixels inside.
        corners: (4, 3) right, down and ahead of the camera, metres; 0, 1 and 3 span its texture.
        texels: of all textures.
        skin: the row of its texture in the table.
        surface: (4, 3) how it takes light.
        sunlight: where that comes from.
    """
    plane, count = plane_of(view, corners), 0
    # A fading rim would run far out at a sharp corner: the corners themselves bound it.
    left, right = _span(polygon, 0, view.width - 1.0)
    top, bottom = _span(polygon, 1, view.height - 1.0)
    last = int(np.floor(bottom))
    for y in range(int(np.ceil(top)), last + 1):
        count = _collect(canvas.clear[y], y, _interval(edges, y, left, right), edges, pixels, count)
        if y == last or count + view.width > CAPACITY:
            paint_face(canvas, pixels, count, plane, texels, skin, surface, sunlight)
            count = 0


@njit(cache=True, error_model="numpy")
def _collect(
    row: NDArray[np.float32],
    y: int,
    columns: tuple[float, float, float, float],
    edges: NDArray[np.float64],
    pixels: Pixels,
    count: int,
) -> int:
    """Add the pixels of row y that a face touches, and that are not full, to the batch."""
    left, right, inner_left, inner_right = columns
    for x in range(int(np.ceil(left)), int(np.floor(right)) + 1):
        clear = float(row[x])
        if clear > OPAQUE:
            if x < inner_left or x > inner_right:
                clear *= _cover(edges, x, y)
            pixels.x[count], pixels.y[count], pixels.clear[count] = x, y, clear
            count += 1
    return count


@njit(cache=True, error_model="numpy")
def _span(polygon: NDArray[np.float64], axis: int, last: float) -> tuple[float, float]:
    """From where to where a face reaches on one axis of the picture, pixels."""
    low, high = polygon[0, axis], polygon[0, axis]
    for i in range(1, polygon.shape[0]):
        low, high = min(low, polygon[i, axis]), max(high, polygon[i, axis])
    return max(low - 0.5, 0.0), min(high + 0.5, last)


@njit(cache=True, error_model="numpy")
def _interval(edges: NDArray[np.float64], y: int, left: float, right: float) -> tuple[float, float, float, float]:
    """The columns of row y that a face touches, and those that it covers whole."""
    inner_left, inner_right = left, right
    for i in range(edges.shape[0]):
        a, rest = edges[i, 0], edges[i, 1] * y + edges[i, 2]
        if a > 1e-9:
            left, inner_left = max(left, -(rest + _RIM) / a), max(inner_left, -rest / a)
        elif a < -1e-9:
            right, inner_right = min(right, -(rest + _RIM) / a), min(inner_right, -rest / a)
        elif rest < 0.0:
            inner_right = -1.0
            if rest <= -_RIM:
                right = -1.0
    return left, right, inner_left, inner_right


@njit(cache=True, error_model="numpy")
def _cover(edges: NDArray[np.float64], x: int, y: int) -> float:
    """Share of a pixel that a face covers, 0..1: one inside, fading over the rim."""
    inside = 0.0
    for i in range(edges.shape[0]):
        inside = min(inside, edges[i, 0] * x + edges[i, 1] * y + edges[i, 2])
    return max(inside + _RIM, 0.0)
