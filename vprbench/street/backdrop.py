"""What fills the pixels that no thing covers: the ground below the horizon and the sky above it."""

from __future__ import annotations

import numpy as np
from numba import njit

from vprbench.street.course import BEHIND, SPACING
from vprbench.street.raster import OPAQUE
from vprbench.street.sunlight import lit
from vprbench.street.texture import sample

__all__ = ["GROUND_HALF", "GROUND_PERIOD", "GROUND_ROAD", "SKY_TOP", "paint_ground", "paint_sky"]

# The ground texture repeats along the street after so many metres and reaches so far to either side;
# its road is drawn so many metres half-wide, and stretched to the width that the street has.
GROUND_PERIOD = 64.0
GROUND_HALF = 16.0
GROUND_ROAD = 4.0
# Elevation of the sky texture's upper edge, radians.
SKY_TOP = 0.5


@njit(cache=True, error_model="numpy")
def paint_ground(canvas, view, course, skins, skin, sunlight):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN201
    """Paint the ground; `course` holds (east, north, cos, sin, half the road's width) of every sample."""
    up = sunlight.toward[2] * sunlight.direct
    for y in range(max(int(np.ceil(view.cy)) + 1, 0), view.height):
        ahead = view.up * view.fy / (y - view.cy)
        if ahead > 400.0:
            continue
        station = min(view.station + ahead, (course.shape[0] - 2) * SPACING - BEHIND)
        reach = ahead * ahead / (view.up * view.fy)  # ground covered by one row
        across = ahead / view.fx  # and by one column
        for x in range(view.width):
            clear = canvas.clear[y, x]
            if clear <= OPAQUE:
                continue
            right = (x - view.cx) * across
            east = view.east + ahead * view.sin + right * view.cos
            north = view.north + ahead * view.cos - right * view.sin
            station, lateral, half, turn = _street_coordinates(course, station, east, north, view)
            far = abs(lateral) - half
            flat = lateral * GROUND_ROAD / half if far < 0 else np.sign(lateral) * (GROUND_ROAD + far)
            period = station / GROUND_PERIOD
            along = (reach + turn * across) / GROUND_PERIOD
            luma, _ = sample(
                skins.texels,
                skins.table[skin],
                period - np.floor(period),
                0.5 + flat / (2 * GROUND_HALF),
                along,
                (across + turn * reach) / (2 * GROUND_HALF),
            )
            light = 1.0 + up * lit(sunlight, station, lateral, 0.0)
            canvas.light[y, x] += clear * luma * light / 255.0
            canvas.clear[y, x] = 0.0


@njit(cache=True, error_model="numpy")
def _street_coordinates(course, station, east, north, view):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
    """Station, lateral, half width and the sine of the street's turn off the view, by Newton's method."""
    lateral, half, turn = 0.0, 1.0, 0.0
    for _ in range(2):
        at = min(max((station + BEHIND) / SPACING, 0.0), course.shape[0] - 1.001)
        i = int(at)
        t = at - i
        here, there = course[i], course[i + 1]
        cos, sin = here[2] + t * (there[2] - here[2]), here[3] + t * (there[3] - here[3])
        de = east - here[0] - t * (there[0] - here[0])
        dn = north - here[1] - t * (there[1] - here[1])
        station += de * sin + dn * cos
        lateral = de * cos - dn * sin
        half = here[4] + t * (there[4] - here[4])
        turn = abs(sin * view.cos - cos * view.sin)
    return station, lateral, half, turn


@njit(cache=True, error_model="numpy")
def paint_sky(canvas, view, skins, skin, heading):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN201
    """Paint the sky, a texture at infinity that spans the whole round of azimuths."""
    for x in range(view.width):
        rx = (x - view.cx) / view.fx
        azimuth = (heading + np.arctan(rx)) / (2 * np.pi)
        u = azimuth - np.floor(azimuth)
        slant = np.sqrt(1.0 + rx * rx)
        du = 1.0 / (view.fx * slant * slant * 2 * np.pi)
        for y in range(view.height):
            clear = canvas.clear[y, x]
            if clear <= OPAQUE:
                continue
            v = 1.0 - (view.cy - y) / (view.fy * slant * SKY_TOP)
            luma, _ = sample(skins.texels, skins.table[skin], u, v, du, 1.0 / (view.fy * SKY_TOP))
            canvas.light[y, x] += clear * luma * (4.0 / 255.0)
            canvas.clear[y, x] = 0.0
