"""Sunlight on a street: how bright a surface is, and where houses and trees cast their shadow.

Shadows are found in street coordinates: the ray towards the sun meets the row of houses (or of trees) on
its side of the road at some station and height, and the row's outline there says whether it passes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64
from numba import njit
from numpy.typing import NDArray

from vprbench.street.course import BEHIND, Course
from vprbench.street.pixels import Pixels

__all__ = ["Outline", "Sunlight", "illuminate", "shade_stations", "sun_over"]

_STEP = 0.125  # metres of street between the samples of an outline
_PENUMBRA = 0.25  # metres over which a shadow's edge fades
_LEAVES = 3.0  # clumps of leaves to a metre
_DIRECT = 2.2  # sunlight on a surface that faces the sun; in the shade it is about 1

# Left side and right side of the street at every shade station.
Sides = Float64[np.ndarray, "2 stations"]


def shade_stations(course: Course) -> Float64[np.ndarray, " stations"]:
    """The stations at which outlines are sampled, metres."""
    return np.arange(-BEHIND, course.stations[-1], _STEP)


@dataclass(frozen=True)
class Outline:
    """What stands in the sun's way along the street, all in metres.

    Attributes:
        wall, crown: distance of the houses, and of the trees, from the middle of the road.
        height: of the houses, 0 between them.
        low, high: lower and upper end of the crowns; between them low is 1 and high is 0, so that nothing
            lies within.
    """

    wall: Sides
    crown: Sides
    height: Sides
    low: Sides
    high: Sides


class Sunlight(NamedTuple):
    """The sun over one drive, as the painter reads it.

    Attributes:
        toward: unit vector to the sun (east, north, up).
        direct: brightness of a surface that faces the sun, of one in the shade 1.
        rays: of every shade station, the sun's side of the street (-1 left, +1 right), the metres along the
            street and upwards on the ray to the sun per metre across it, and the distance of the houses and
            of the trees on that side.
        casters: of every shade station, the height of the houses and the lower and upper end of the crowns
            on the sun's side.
        leaves: (64, 64) random numbers 0..1, for the gaps in the crowns.
    """

    toward: Float64[np.ndarray, "3"]
    direct: float
    rays: Float64[np.ndarray, "stations 5"]
    casters: Float64[np.ndarray, "stations 3"]
    leaves: Float64[np.ndarray, "64 64"]


def sun_over(
    course: Course, outline: Outline, azimuth: float, elevation: float, leaves: Float64[np.ndarray, "64 64"]
) -> Sunlight:
    """The sun at an azimuth (clockwise from north) and elevation, radians."""
    relative = azimuth - course.heading_at(shade_stations(course))
    across, flat = np.sin(relative), np.cos(elevation)
    # Where the sun stands along the street, no shadow falls across it for very long.
    per_metre = 1.0 / np.maximum(np.abs(across), 0.1)
    right, every = (across >= 0).astype(np.int64), np.arange(len(across))
    wall, crown, *casters = (
        sides[right, every] for sides in (outline.wall, outline.crown, outline.height, outline.low, outline.high)
    )
    along, rise = np.cos(relative) * per_metre, np.tan(elevation) * per_metre
    return Sunlight(
        toward=np.array([np.sin(azimuth) * flat, np.cos(azimuth) * flat, np.sin(elevation)]),
        direct=_DIRECT,
        rays=np.stack([2.0 * right - 1.0, along, rise, wall, crown], axis=1),
        casters=np.stack(casters, axis=1),
        leaves=leaves,
    )


@njit(cache=True, error_model="numpy")
def illuminate(sunlight: Sunlight, pixels: Pixels, count: int) -> None:
    """Find the share of the sun's light, 0..1, that reaches each pixel of a batch."""
    rays, casters, leaves = sunlight.rays, sunlight.casters, sunlight.leaves
    last = rays.shape[0] - 1.0
    inside, at = pixels.u, pixels.v
    for i in range(count):
        station, height = pixels.station[i], pixels.up[i]
        here = _sample_at(station, last)
        along, rise, toward_sun = rays[here, 1], rays[here, 2], rays[here, 0] * pixels.lateral[i]
        across = rays[here, 3] - toward_sun
        there = _sample_at(station + across * along, last)
        over = min(max((height + across * rise - casters[there, 0]) / _PENUMBRA + 0.5, 0.0), 1.0)
        pixels.light[i] = over if across > 0.2 else 1.0
        across = rays[here, 4] - toward_sun
        at[i], up = station + across * along, height + across * rise
        there = _sample_at(at[i], last)
        pixels.up[i] = up
        depth = min(up - casters[there, 1], casters[there, 2] - up) * 1.5 + 0.5
        inside[i] = min(depth, 1.0) if across > 0.0 else 0.0
    for i in range(count):
        if inside[i] > 0.0 and pixels.light[i] > 0.0:
            pixels.light[i] *= 1.0 - inside[i] * _leafage(leaves, at[i] * _LEAVES, pixels.up[i] * _LEAVES)


@njit(cache=True, error_model="numpy", inline="always")
def _sample_at(station: float, last: float) -> np.uint32:
    """The number of the shade station there; of a ray that runs off the street, the last."""
    return np.uint32(min(max(0.0, (station + BEHIND) / _STEP), last))


@njit(cache=True, error_model="numpy")
def _leafage(leaves: NDArray[np.float64], x: float, y: float) -> float:
    """How much light a crown holds back at one spot, 0..1; the pattern repeats."""
    i, j = int(np.floor(x)), int(np.floor(y))
    fx, fy = x - i, y - j
    i, j, right, below = i & 63, j & 63, (i + 1) & 63, (j + 1) & 63
    upper = leaves[j, i] + fx * (leaves[j, right] - leaves[j, i])
    lower = leaves[below, i] + fx * (leaves[below, right] - leaves[below, i])
    return min(max((upper + fy * (lower - upper)) * 4.0 - 0.8, 0.35), 1.0)
