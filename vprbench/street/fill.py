"""The filler: paints the pixels of one projected face, each through the clearness that is left."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.street.canvas import OPAQUE, Canvas, View
from vprbench.street.sunlight import Sunlight, lit
from vprbench.street.texture import choose_level, sample

__all__ = ["cross", "fill"]

# A face reaches this far beyond its edges, pixels: fading there, it meets its neighbour without a gap.
_RIM = 1.0
# Texture levels are chosen anew every so many pixels (a power of two).
_RUN = 8


_Line = tuple[float, float, float]  # a x + b y + c of pixels
_Plane = tuple[_Line, _Line, _Line]


@njit(cache=True, error_model="numpy")
def fill(
    canvas: Canvas,
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
        view: the camera.
        polygon: (n, 3) the face's corners in the picture, pixels.
        edges: (n, 3) a, b, c of its edges, a x + b y + c being the pixels inside.
        corners: (4, 3) right, down and ahead of the camera, metres; 0, 1 and 3 span its texture.
        texels: of all textures.
        skin: the row of its texture in the table.
        surface: (4, 3) how it takes light.
        sunlight: where that comes from.
    """
    plane = _plane(view, corners)
    # A fading rim would run far out at a sharp corner: the corners themselves bound it.
    left, right = _span(polygon, 0, view.width - 1.0)
    top, bottom = _span(polygon, 1, view.height - 1.0)
    for y in range(int(np.ceil(top)), int(np.floor(bottom)) + 1):
        columns = _interval(edges, y, left, right)
        if columns[0] <= columns[1]:
            _fill_row(canvas, y, columns, plane, edges, texels, skin, surface, sunlight)


@njit(cache=True, error_model="numpy")
def _fill_row(
    canvas: Canvas,
    y: int,
    columns: tuple[float, float, float, float],
    plane: _Plane,
    edges: NDArray[np.float64],
    texels: NDArray[np.uint16],
    skin: NDArray[np.int64],
    surface: NDArray[np.float64],
    sunlight: Sunlight,
) -> None:
    """Paint one row of a face: perspective is linear in each of u w, v w and w."""
    left, right, inner_left, inner_right = columns
    (u_x, u_y, u_1), (v_x, v_y, v_1), (w_x, w_y, w_1) = plane
    shade, sun = surface[0, 0] / 255.0, surface[0, 1] / 255.0
    level, stale = (0, 1, 1), True
    for x in range(int(np.ceil(left)), int(np.floor(right)) + 1):
        clear = canvas.clear[y, x]
        if clear <= OPAQUE:
            stale = True
            continue
        w = 1.0 / (w_x * x + w_y * y + w_1)
        u, v = (u_x * x + u_y * y + u_1) * w, (v_x * x + v_y * y + v_1) * w
        if stale or x & (_RUN - 1) == 0:
            du, dv = abs(u_x - u * w_x) + abs(u_y - u * w_y), abs(v_x - v * w_x) + abs(v_y - v * w_y)
            level, stale = choose_level(skin, du * abs(w), dv * abs(w)), False
        luma, alpha = sample(texels, skin, level, u, v)
        if alpha == 0.0:
            continue
        light = shade
        if sun > 0.0:
            light += sun * _sun(surface, sunlight, u, v)
        if x < inner_left or x > inner_right:
            clear *= _cover(edges, x, y)
        canvas.light[y, x] += clear * luma * light
        canvas.clear[y, x] -= clear * alpha / 255.0


@njit(cache=True, error_model="numpy")
def _plane(view: View, corners: NDArray[np.float64]) -> _Plane:
    """The numerators of u and v and their common denominator, in pixels.

    A ray r meets the plane through corner o, spanned by the axes u and v, where u = r . (v x o) / r . (u x v)
    and v = r . (o x u) / r . (u x v).
    """
    origin, u_axis, v_axis = corners[0], corners[1] - corners[0], corners[3] - corners[0]
    return (
        _in_pixels(view, cross(v_axis, origin)),
        _in_pixels(view, cross(origin, u_axis)),
        _in_pixels(view, cross(u_axis, v_axis)),
    )


@njit(cache=True, error_model="numpy")
def cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> _Line:
    """The vector product of a and b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True, error_model="numpy")
def _in_pixels(view: View, normal: _Line) -> _Line:
    a, b = normal[0] / view.fx, normal[1] / view.fy
    return a, b, normal[2] - a * view.cx - b * view.cy


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


@njit(cache=True, error_model="numpy", inline="always")
def _sun(surface: NDArray[np.float64], sunlight: Sunlight, u: float, v: float) -> float:
    """Share of the sun's light at (u, v) of a face."""
    station = surface[1, 0] + u * surface[2, 0] + v * surface[3, 0]
    lateral = surface[1, 1] + u * surface[2, 1] + v * surface[3, 1]
    return lit(sunlight, station, lateral, surface[1, 2] + u * surface[2, 2] + v * surface[3, 2])
