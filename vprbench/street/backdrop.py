"""What fills the pixels that no thing covers: the ground below the horizon and the sky above it."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.street.canvas import OPAQUE, Canvas, View
from vprbench.street.course import BEHIND, SPACING
from vprbench.street.sunlight import Sunlight, lit
from vprbench.street.texture import choose_level, sample

__all__ = ["GROUND_HALF", "GROUND_PERIOD", "GROUND_ROAD", "SKY_TOP", "paint_ground", "paint_sky"]

# The ground texture repeats along the street after so many metres and reaches so far to either side;
# its road is drawn so many metres half-wide, and stretched to the width that the street has.
GROUND_PERIOD = 64.0
GROUND_HALF = 16.0
GROUND_ROAD = 4.0
# Elevation of the sky texture's upper edge, radians.
SKY_TOP = 0.5
# How much brighter than sunlit white paper the sky's texture may be.
SKY_LIGHT = 4.0


@njit(cache=True, error_model="numpy")
def paint_ground(
    canvas: Canvas,
    view: View,
    course: NDArray[np.float64],
    texels: NDArray[np.uint16],
    skin: NDArray[np.int64],
    sunlight: Sunlight,
) -> None:
    """Paint the ground; `course` holds (east, north, cos, sin, half the road's width) of every sample."""
    up = sunlight.toward[2] * sunlight.direct
    for y in range(max(int(np.ceil(view.cy)) + 1, 0), view.height):
        ahead = view.up * view.fy / (y - view.cy)
        reach, across = ahead * ahead / (view.up * view.fy), ahead / view.fx  # covered by a row, a column
        station, last = min(view.station + ahead, (course.shape[0] - 2) * SPACING - BEHIND), -9
        level = (0, 1, 1)
        for x in range(view.width):
            clear = canvas.clear[y, x]
            if clear <= OPAQUE:
                continue
            right = (x - view.cx) * across
            east = view.east + ahead * view.sin + right * view.cos
            north = view.north + ahead * view.cos - right * view.sin
            # The pixel to the left is so near that one step of Newton's method does.
            steps = 1 if x == last + 1 else 4
            station, lateral, half, turn = _street_coordinates(course, station, east, north, view, steps)
            if x & 7 == 0 or x != last + 1:
                along, aside = reach + turn * across, across + turn * reach
                level = choose_level(skin, along / GROUND_PERIOD, aside / (2 * GROUND_HALF))
            last = x
            far = abs(lateral) - half
            flat = lateral * GROUND_ROAD / half if far < 0 else np.sign(lateral) * (GROUND_ROAD + far)
            period = station / GROUND_PERIOD
            luma, _ = sample(texels, skin, level, period - np.floor(period), 0.5 + flat / (2 * GROUND_HALF))
            light = 1.0 + up * lit(sunlight, station, lateral, 0.0)
            canvas.light[y, x] += clear * luma * light / 255.0
            canvas.clear[y, x] = 0.0


@njit(cache=True, error_model="numpy")
def _street_coordinates(
    course: NDArray[np.float64], station: float, east: float, north: float, view: View, steps: int
) -> tuple[float, float, float, float]:
    """Station, lateral, half width and the sine of the street's turn off the view, by Newton's method."""
    lateral, half, turn = 0.0, 1.0, 0.0
    for _ in range(steps):
        at = min(max((station + BEHIND) / SPACING, 0.0), course.shape[0] - 1.001)
        i = int(at)
        t = at - i
        cos, sin = (
            course[i, 2] + t * (course[i + 1, 2] - course[i, 2]),
            course[i, 3] + t * (course[i + 1, 3] - course[i, 3]),
        )
        de = east - course[i, 0] - t * (course[i + 1, 0] - course[i, 0])
        dn = north - course[i, 1] - t * (course[i + 1, 1] - course[i, 1])
        station += de * sin + dn * cos
        lateral = de * cos - dn * sin
        half = course[i, 4] + t * (course[i + 1, 4] - course[i, 4])
        turn = abs(sin * view.cos - cos * view.sin)
    return station, lateral, half, turn


@njit(cache=True, error_model="numpy")
def paint_sky(canvas: Canvas, view: View, texels: NDArray[np.uint16], skin: NDArray[np.int64]) -> None:
    """Paint the sky, a texture at infinity that spans the whole round of azimuths."""
    heading = np.arctan2(view.sin, view.cos)
    for x in range(view.width):
        rx = (x - view.cx) / view.fx
        azimuth = (heading + np.arctan(rx)) / (2 * np.pi)
        u = azimuth - np.floor(azimuth)
        slant = np.sqrt(1.0 + rx * rx)
        level = choose_level(skin, 1.0 / (view.fx * slant * slant * 2 * np.pi), 1.0 / (view.fy * SKY_TOP))
        for y in range(view.height):
            clear = canvas.clear[y, x]
            if clear > OPAQUE:
                v = 1.0 - (view.cy - y) / (view.fy * slant * SKY_TOP)
                luma, _ = sample(texels, skin, level, u, v)
                canvas.light[y, x] += clear * luma * SKY_LIGHT / 255.0
                canvas.clear[y, x] = 0.0
