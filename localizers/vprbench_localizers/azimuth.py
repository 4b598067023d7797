"""The where pathway: the compass direction of each landmark, and how well two directions agree."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Float64, Int64
from numba import njit
from numpy.typing import NDArray

from vprbench.geodesy import wrap

__all__ = ["agreeing_pairs", "azimuths"]

Pairs = tuple[Int64[np.ndarray, " pairs"], Int64[np.ndarray, " pairs"], Float32[np.ndarray, " pairs"]]


def azimuths(
    columns: Float32[np.ndarray, " points"], heading: float, camera: Float64[np.ndarray, "2"]
) -> Float32[np.ndarray, " points"]:
    """The direction of each image column, heading + atan((u - cx) / fx), wrapped to -pi..pi.

    Args:
        columns: u of each landmark, pixels.
        heading: of the camera, radians.
        camera: focal length fx and principal column cx, pixels.
    """
    fx, cx = camera
    return wrap(heading + np.arctan((columns.astype(np.float64) - cx) / fx)).astype(np.float32)


@njit(cache=True)
def _agreeing_pairs(
    queries: NDArray[np.float32], units: NDArray[np.float32], width: float, reach: float
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float32]]:
    pi = np.float32(np.pi)
    query_index = np.empty(len(queries) * len(units), np.int64)
    unit_index = np.empty_like(query_index)
    agreement = np.empty(len(query_index), np.float32)
    count = 0
    for m in range(len(units)):
        for p in range(len(queries)):
            turn = abs(queries[p] - units[m])
            if turn > pi:
                turn = abs(turn - 2 * pi)
            if turn <= reach:
                query_index[count], unit_index[count] = p, m
                agreement[count] = np.exp(-0.5 * (turn / width) ** 2)
                count += 1
    return query_index[:count], unit_index[:count], agreement[:count]


def agreeing_pairs(
    queries: Float32[np.ndarray, " points"],
    units: Float32[np.ndarray, " units"],
    width: float,
    reach: float,
) -> Pairs:
    """Which pairs (query p, unit m) of azimuths agree, and how well: exp(-(theta_p - theta_m)^2 / 2 width^2).

    Pairs more than `reach` apart do not agree at all and are left out. An infinite width lets all agree fully.

    Args:
        queries: azimuths in -pi..pi.
        units: azimuths in -pi..pi.
        width: of the Gaussian, radians.
        reach: largest difference that agrees, radians.

    Returns:
        The query index, unit index and agreement (0..1) of each pair, unit by unit.
    """
    return _agreeing_pairs(queries, units, width, reach)
