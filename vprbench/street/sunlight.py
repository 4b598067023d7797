"""Sunlight on a street: how bright a surface is, and where houses and trees cast their shadow.

Shadows are found in street coordinates: the ray towards the sun meets the row of houses (or of trees) on
its side of the road at some station and height, and the row's outline there says whether it passes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float64
from numba import njit

from vprbench.street.course import BEHIND, SPACING, Course

__all__ = ["CROWN_HIGH", "CROWN_LATERAL", "CROWN_LOW", "WALL_HEIGHT", "WALL_LATERAL", "Outline", "Sunlight", "lit"]

# What stands along the street: (side, station, quantity), side 0 left and 1 right, all in metres.
Outline = Float64[np.ndarray, "2 stations 5"]
WALL_LATERAL, WALL_HEIGHT, CROWN_LATERAL, CROWN_LOW, CROWN_HIGH = range(5)

_PENUMBRA = 0.25  # metres over which a shadow's edge fades


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
        relative = azimuth - course.heading
        across = np.sin(relative)
        per_metre = 1.0 / np.maximum(np.abs(across), 0.05)
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


@njit(cache=True, error_model="numpy")
def lit(sunlight, station, lateral, height):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN201
    """Share of the sun's light, 0..1, that reaches a point given in street coordinates, metres."""
    last = sunlight.along.size - 1
    here = min(max(int((station + BEHIND) / SPACING), 0), last)
    side = sunlight.side[here]
    row = sunlight.outline[1 if side > 0 else 0]
    across = row[here, WALL_LATERAL] - side * lateral
    if across < 0.2:
        return 1.0
    there = min(max(int((station + across * sunlight.along[here] + BEHIND) / SPACING), 0), last)
    over = height + across * sunlight.rise[here] - row[there, WALL_HEIGHT]
    light = min(max(over / _PENUMBRA + 0.5, 0.0), 1.0)
    across = row[here, CROWN_LATERAL] - side * lateral
    if across <= 0.0 or light == 0.0:
        return light
    behind = station + across * sunlight.along[here]
    there = min(max(int((behind + BEHIND) / SPACING), 0), last)
    up = height + across * sunlight.rise[here]
    low, high = row[there, CROWN_LOW], row[there, CROWN_HIGH]
    inside = min(max((min(up - low, high - up)) * 2.0 + 0.5, 0.0), 1.0)
    if inside > 0.0:
        gap = sunlight.leaves[int(up * 5.0) & 63, int(behind * 5.0) & 63]
        light *= 1.0 - inside * (0.6 + 0.4 * gap)
    return light
