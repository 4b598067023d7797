"""What the pixels of a face show: its texture in perspective, and the light that falls on it."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.street.canvas import Canvas, View
from vprbench.street.pixels import Pixels, drop_unseen, lay
from vprbench.street.sunlight import Sunlight, illuminate
from vprbench.street.texture import RUN, choose_level, sample

__all__ = ["cross", "paint_face", "plane_of"]

_Line = tuple[float, float, float]  # a x + b y + c of pixels
_Plane = tuple[_Line, _Line, _Line]


@njit(cache=True, error_model="numpy")
def paint_face(
    canvas: Canvas,
    pixels: Pixels,
    count: int,
    plane: _Plane,
    texels: NDArray[np.uint16],
    skin: NDArray[np.int64],
    surface: NDArray[np.float64],
    sunlight: Sunlight,
) -> None:
    """Paint a batch of pixels of a face.

    Args:
        canvas: what has been painted so far.
        pixels: where in the picture, and how clear.
        count: of pixels.
        plane: of the face.
        texels: of all textures.
        skin: the row of its texture in the table.
        surface: (4, 3) how it takes light: (in the shade, added by the sun) and its street coordinates.
        sunlight: where that comes from.
    """
    _locate(pixels, count, plane)
    _choose_levels(pixels, count, plane, skin)
    sample(texels, skin, pixels, count)
    count = drop_unseen(pixels, count)
    _light(pixels, count, surface, sunlight)
    lay(canvas, pixels, count, 1.0)


@njit(cache=True, error_model="numpy")
def _locate(pixels: Pixels, count: int, plane: _Plane) -> None:
    """Find the place in the texture: perspective is linear in each of u w, v w and w."""
    (u_x, u_y, u_1), (v_x, v_y, v_1), (w_x, w_y, w_1) = plane
    for i in range(count):
        x, y = pixels.x[i], pixels.y[i]
        w = 1.0 / (w_x * x + w_y * y + w_1)
        pixels.u[i], pixels.v[i] = (u_x * x + u_y * y + u_1) * w, (v_x * x + v_y * y + v_1) * w
        pixels.light[i] = w


@njit(cache=True, error_model="numpy")
def _choose_levels(pixels: Pixels, count: int, plane: _Plane, skin: NDArray[np.int64]) -> None:
    """Choose the level of the texture anew wherever a run of pixels begins."""
    (u_x, u_y, _), (v_x, v_y, _), (w_x, w_y, _) = plane
    level, last_x, last_y = (0, 1, 1), -9, -9
    for i in range(count):
        x, y = pixels.x[i], pixels.y[i]
        if x & (RUN - 1) == 0 or x != last_x + 1 or y != last_y:
            u, v, w = pixels.u[i], pixels.v[i], abs(pixels.light[i])
            du, dv = abs(u_x - u * w_x) + abs(u_y - u * w_y), abs(v_x - v * w_x) + abs(v_y - v * w_y)
            level = choose_level(skin, du * w, dv * w)
        last_x, last_y = x, y
        pixels.first[i], pixels.wide[i], pixels.high[i] = level


@njit(cache=True, error_model="numpy")
def _light(pixels: Pixels, count: int, surface: NDArray[np.float64], sunlight: Sunlight) -> None:
    """Find how bright the face is, in parts of a white texel."""
    shade, sun = surface[0, 0] / 255.0, surface[0, 1] / 255.0
    if sun <= 0.0:
        for i in range(count):
            pixels.light[i] = shade
        return
    for axis, place in enumerate((pixels.station, pixels.lateral, pixels.up)):
        at, per_u, per_v = surface[1, axis], surface[2, axis], surface[3, axis]
        for i in range(count):
            place[i] = at + pixels.u[i] * per_u + pixels.v[i] * per_v
    illuminate(sunlight, pixels, count)
    for i in range(count):
        pixels.light[i] = shade + sun * pixels.light[i]


@njit(cache=True, error_model="numpy")
def plane_of(view: View, corners: NDArray[np.float64]) -> _Plane:
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
