"""Sunlight on a street: how bright a surface is, and where houses and trees cast their shadow.

Shadows are found in street coordinates: the ray towards the sun meets the row of houses (or of trees) on
its side of the road at some station and height, and the row's outline there says whether it passes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float64
from numba import njit
from numpy.typing import NDArray

from vprbench.street.course import BEHIND, Course

__all__ = [
    "CROWN_HIGH",
    "CROWN_LATERAL",
    "CROWN_LOW",
    "WALL_HEIGHT",
    "WALL_LATERAL",
    "Outline",
    "Sunlight",
    "lit",
    "shade_stations",
]

# What stands along the street: (side, station, quantity), side 0 left and 1 right, all in metres.
Outline = Float64[np.ndarray, "2 stations 5"]
WALL_LATERAL, WALL_HEIGHT, CROWN_LATERAL, CROWN_LOW, CROWN_HIGH = range(5)

_STEP = 0.125  # metres of street between the samples of an outline
_PENUMBRA = 0.25  # metres over which a shadow's edge fades
_LEAVES = 3.0  # clumps of leaves to a metre


def shade_stations(course: Course) -> Float64[np.ndarray, " stations"]:
    """The stations at which outlines are sampled, metres."""
    return np.arange(-BEHIND, course.stations[-1], _STEP)


class Sunlight(NamedTuple):
    """The sun over one drive.

    Attributes:
        toward: unit vector to the sun (east, north, up).
        direct: brightness of a surface that faces the sun, of one in the shade 1.
        along, rise: (stations,) metres along the street and upwards on the ray to the sun, per metre
            across the street.
        side: (stations,) -1 where the sun is to the left of the street, +1 to the right.
        outline: what casts the shadows.
        leaves: (64, 64) random numbers 0..1, for the gaps in the crowns.
    """

    toward: Float64[np.ndarray, "3"]
    direct: float
    along: Float64[np.ndarray, " stations"]
    rise: Float64[np.ndarray, " stations"]
    side: Float64[np.ndarray, " stations"]
    outline: Outline
    leaves: Float64[np.ndarray, "64 64"]

    @classmethod
    def over(
        cls, course: Course, outline: Outline, azimuth: float, elevation: float, leaves: Float64[np.ndarray, "64 64"]
    ) -> Sunlight:
        """The sun at an azimuth (clockwise from north) and elevation, radians."""
        relative = azimuth - course.heading_at(shade_stations(course))
        across = np.sin(relative)
        per_metre = 1.0 / np.maximum(np.abs(across), 0.1)
        flat = np.cos(elevation)
        return cls(
            toward=np.array([np.sin(azimuth) * flat, np.cos(azimuth) * flat, np.sin(elevation)]),
            direct=2.2,
            along=np.cos(relative) * per_metre,
            rise=np.tan(elevation) * per_metre,
            side=np.where(across < 0, -1.0, 1.0),
            outline=outline,
            leaves=leaves,
        )


@njit(cache=True, error_model="numpy", inline="always")
def lit(sunlight: Sunlight, station: float, lateral: float, height: float) -> float:
    """Share of the sun's light, 0..1, that reaches a point given in street coordinates, metres."""
    light = 1.0
    last = sunlight.along.size - 1
    here = min(max(int((station + BEHIND) / _STEP), 0), last)
    side, along, rise = sunlight.side[here], sunlight.along[here], sunlight.rise[here]
    row = 1 if side > 0 else 0
    across = sunlight.outline[row, here, WALL_LATERAL] - side * lateral
    if across > 0.2:
        there = min(max(int((station + across * along + BEHIND) / _STEP), 0), last)
        wall = sunlight.outline[row, there, WALL_HEIGHT]
        light = min(max((height + across * rise - wall) / _PENUMBRA + 0.5, 0.0), 1.0)
    across = sunlight.outline[row, here, CROWN_LATERAL] - side * lateral
    if across > 0.0 and light > 0.0:
        at = station + across * along
        there = min(max(int((at + BEHIND) / _STEP), 0), last)
        up = height + across * rise
        low, high = sunlight.outline[row, there, CROWN_LOW], sunlight.outline[row, there, CROWN_HIGH]
        inside = min(max(min(up - low, high - up) * 1.5 + 0.5, 0.0), 1.0)
        if inside > 0.0:
            light *= 1.0 - inside * _leafage(sunlight.leaves, at * _LEAVES, up * _LEAVES)
    return light


@njit(cache=True, error_model="numpy")
def _leafage(leaves: NDArray[np.float64], x: float, y: float) -> float:
    """How much light a crown holds back at one spot, 0..1; the pattern repeats."""
    i, j = int(np.floor(x)), int(np.floor(y))
    fx, fy = x - i, y - j
    i, j, right, below = i & 63, j & 63, (i + 1) & 63, (j + 1) & 63
    upper = leaves[j, i] + fx * (leaves[j, right] - leaves[j, i])
    lower = leaves[below, i] + fx * (leaves[below, right] - leaves[below, i])
    return min(max((upper + fy * (lower - upper)) * 4.0 - 0.8, 0.35), 1.0)
