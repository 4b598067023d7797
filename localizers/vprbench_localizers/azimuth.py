"""The where pathway: the compass direction of each landmark, and how well two directions agree."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Float64, Int64
from numba import njit
from numpy.typing import NDArray

from vprbench.geodesy import wrap

__all__ = ["agreeing_pairs", "agreement", "azimuths", "turn"]

Pairs = tuple[Int64[np.ndarray, " pairs"], Int64[np.ndarray, " pairs"]]


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
def turn(one: np.float32, other: np.float32) -> float:
    """The angle between two azimuths in -pi..pi, the short way round."""
    turn = abs(one - other)
    # The smaller of both ways round, since a branch that is hard to predict would cost more than all else here.
    return min(float(turn), float(abs(turn - 2 * np.float32(np.pi))))


@njit(cache=True)
def agreement(one: np.float32, other: np.float32, width: float) -> np.float32:
    """How well two azimuths in -pi..pi agree: exp(-(theta_p - theta_m)^2 / 2 width^2); an infinite width lets all."""
    return np.float32(np.exp(-0.5 * (turn(one, other) / width) ** 2))


@njit(cache=True)
def _agreeing_pairs(
    queries: NDArray[np.float32], units: NDArray[np.float32], reach: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    # One more than can be found: a pair that does not agree is written too, and then written over.
    query_index = np.empty(len(queries) * len(units) + 1, np.int64)
    unit_index = np.empty_like(query_index)
    count = 0
    for m in range(len(units)):
        for p in range(len(queries)):
            query_index[count], unit_index[count] = p, m
            count += turn(queries[p], units[m]) <= reach
    return query_index[:count], unit_index[:count]


def agreeing_pairs(
    queries: Float32[np.ndarray, " points"], units: Float32[np.ndarray, " units"], reach: float
) -> Pairs:
    """Which pairs (query p, unit m) of azimuths are at most `reach` apart.

    Args:
        queries: azimuths in -pi..pi.
        units: azimuths in -pi..pi.
        reach: largest difference that agrees, radians.

    Returns:
        The query index and unit index of each pair, unit by unit.
    """
    return _agreeing_pairs(queries, units, reach)
