"""From the globe to the local plane: angles, compass headings, latitude and longitude in metres."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pymap3d
from jaxtyping import Float64

from vprbench.errors import DataError

__all__ = ["check_geodetic", "compass_heading", "course", "derived_headings", "local_positions", "wrap"]

# Metres of road that a direction is taken over. Our choice: about one car length.
COURSE_WINDOW = 5.0


def wrap(angles: Float64[np.ndarray, "*shape"]) -> Float64[np.ndarray, "*shape"]:
    """The same angles in -pi..pi, radians."""
    return np.arctan2(np.sin(angles), np.cos(angles))


def compass_heading(yaw: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, " n"]:
    """Heading clockwise from north, given a yaw counter-clockwise from east (KITTI's OXTS), radians."""
    return wrap(np.pi / 2 - yaw)


def local_positions(
    geodetic: Float64[np.ndarray, "n 2"], origin: Float64[np.ndarray, "2"]
) -> Float64[np.ndarray, "n 2"]:
    """East and north, metres, in the plane that touches the WGS-84 ellipsoid at the origin.

    Args:
        geodetic: latitude and longitude, degrees; heights are taken as zero.
        origin: latitude and longitude of (0, 0), degrees.
    """
    latitude, longitude = geodetic.T
    east, north, _ = pymap3d.geodetic2enu(latitude, longitude, 0.0, origin[0], origin[1], 0.0)
    return np.stack([east, north], axis=1)


def check_geodetic(geodetic: Float64[np.ndarray, "n 2"], where: Callable[[int], str]) -> None:
    """Refuse latitudes and longitudes that are none; `where` names the file and line of row i."""
    limits = np.array([90.0, 180.0])
    bad = np.argwhere(~(np.abs(geodetic) <= limits))
    if bad.size:
        row, column = bad[0]
        name = ("latitude", "longitude")[column]
        raise DataError(f"{where(int(row))}: {name} {geodetic[row, column]:g} is not within {limits[column]:g} degrees")


def course(positions: Float64[np.ndarray, "n 2"], window: float = COURSE_WINDOW) -> Float64[np.ndarray, " n"]:
    """Heading of the road at each position, radians clockwise from north, seen from the positions alone.

    It is the direction from the frame `window` / 2 metres behind to the one as far ahead, so that the
    noise of single fixes does not turn it. A vehicle that stands keeps the direction it came and goes in.

    Args:
        positions: (n, 2) east and north, metres.
        window: metres of road between the two ends.
    """
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    distance = np.concatenate([[0.0], np.cumsum(steps)])
    behind = np.searchsorted(distance, distance - window / 2, side="right") - 1
    ahead = np.searchsorted(distance, distance + window / 2, side="left")
    span = positions[ahead.clip(max=len(positions) - 1)] - positions[behind.clip(min=0)]
    return np.arctan2(span[:, 0], span[:, 1])


def derived_headings(positions: Float64[np.ndarray, "n 2"], name: str, remedy: str) -> Float64[np.ndarray, " n"]:
    """The course as headings; DataError, with the remedy, where a drive is too short to have one."""
    if np.linalg.norm(np.diff(positions, axis=0), axis=1).sum() < COURSE_WINDOW:
        raise DataError(f"{name}: too short a drive to see its direction; {remedy}")
    return course(positions)
