"""The painter of the ground, which fills what no thing covers below the horizon."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.street.canvas import OPAQUE, Canvas, View
from vprbench.street.course import BEHIND, SPACING
from vprbench.street.pixels import CAPACITY, Pixels, lay, no_pixels
from vprbench.street.sunlight import Sunlight, illuminate
from vprbench.street.texture import RUN, choose_level, sample

__all__ = ["GROUND_HALF", "GROUND_PERIOD", "GROUND_ROAD", "paint_ground"]

# The ground texture repeats along the street after so many metres and reaches so far to either side;
# its road is drawn so many metres half-wide, and stretched to the width that the street has.
GROUND_PERIOD = 64.0
GROUND_HALF = 16.0
GROUND_ROAD = 4.0


@njit(cache=True, error_model="numpy")
def paint_ground(
    canvas: Canvas,
    view: View,
    course: NDArray[np.float64],
    texels: NDArray[np.uint16],
    skin: NDArray[np.int64],
    sunlight: Sunlight,
) -> None:
    """Paint the ground; `course` holds (east, north, cos, sin, half the road's width) of every sample.

    A pixel's station follows from that of its neighbour to the left. So it goes column by column: while one row
    waits for its station, the processor works on the others.
    """
    pixels, count, rows = no_pixels(), 0, _rows(view, course)
    for x in range(view.width):
        count = _collect(canvas.clear, x, view, course, skin, rows, pixels, count)
        if x == view.width - 1 or count + view.height > CAPACITY:
            _paint_batch(canvas, pixels, count, texels, skin, sunlight)
            count = 0


class _Rows(NamedTuple):
    """The rows of a picture as the ground is painted from left to right.

    Attributes:
        ahead: how far ahead the ground lies that is seen there, metres.
        station: of the last pixel painted.
        last: its column.
        first, wide, high: the level of its texture.
    """

    ahead: NDArray[np.float64]
    station: NDArray[np.float64]
    last: NDArray[np.int64]
    first: NDArray[np.int64]
    wide: NDArray[np.int64]
    high: NDArray[np.int64]


@njit(cache=True, error_model="numpy")
def _rows(view: View, course: NDArray[np.float64]) -> _Rows:
    """The rows before anything is painted."""
    ahead, station, last = np.empty(view.height), np.empty(view.height), np.empty(view.height, np.int64)
    level = np.empty((3, view.height), np.int64)
    for y in range(view.height):
        ahead[y] = view.up * view.fy / (y - view.cy)
        station[y] = min(view.station + ahead[y], (course.shape[0] - 2) * SPACING - BEHIND)
        last[y] = -9
    return _Rows(ahead, station, last, level[0], level[1], level[2])


@njit(cache=True, error_model="numpy")
def _collect(
    clear: NDArray[np.float32],
    x: int,
    view: View,
    course: NDArray[np.float64],
    skin: NDArray[np.int64],
    rows: _Rows,
    pixels: Pixels,
    count: int,
) -> int:
    """Add the ground that is seen in column x to the batch."""
    for y in range(max(int(np.ceil(view.cy)) + 1, 0), view.height):
        if clear[y, x] <= OPAQUE:
            continue
        ahead, anew = rows.ahead[y], x != rows.last[y] + 1
        reach, across = ahead * ahead / (view.up * view.fy), ahead / view.fx  # covered by a row, a column
        right = (x - view.cx) * across
        east = view.east + ahead * view.sin + right * view.cos
        north = view.north + ahead * view.cos - right * view.sin
        # The pixel to the left is so near that one step of Newton's method does.
        steps = 4 if anew else 1
        station, lateral, half, turn = _street_coordinates(course, rows.station[y], east, north, view, steps)
        if x & (RUN - 1) == 0 or anew:
            along, aside = reach + turn * across, across + turn * reach
            level = choose_level(skin, along / GROUND_PERIOD, aside / (2 * GROUND_HALF))
            rows.first[y], rows.wide[y], rows.high[y] = level
        rows.station[y], rows.last[y] = station, x
        pixels.x[count], pixels.y[count], pixels.clear[count] = x, y, clear[y, x]
        pixels.u[count], pixels.v[count] = _on_texture(station, lateral, half)
        pixels.first[count], pixels.wide[count], pixels.high[count] = rows.first[y], rows.wide[y], rows.high[y]
        pixels.station[count], pixels.lateral[count], pixels.up[count] = station, lateral, 0.0
        count += 1
    return count


@njit(cache=True, error_model="numpy")
def _on_texture(station: float, lateral: float, half: float) -> tuple[float, float]:
    """Where in the ground's texture a point of the street lies, 0..1."""
    far = abs(lateral) - half
    flat = lateral * GROUND_ROAD / half if far < 0 else np.sign(lateral) * (GROUND_ROAD + far)
    period = station / GROUND_PERIOD
    return period - np.floor(period), 0.5 + flat / (2 * GROUND_HALF)


@njit(cache=True, error_model="numpy")
def _paint_batch(
    canvas: Canvas,
    pixels: Pixels,
    count: int,
    texels: NDArray[np.uint16],
    skin: NDArray[np.int64],
    sunlight: Sunlight,
) -> None:
    """Paint a batch of pixels of the ground."""
    up = sunlight.toward[2] * sunlight.direct
    sample(texels, skin, pixels, count)
    illuminate(sunlight, pixels, count)
    for i in range(count):
        pixels.light[i] = 1.0 + up * pixels.light[i]
    lay(canvas, pixels, count, 255.0)


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
