"""The activity of a unit, and the response of a place: what all kinds of memory compute alike."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, UInt8
from numba import njit
from numpy.typing import NDArray

from vprbench_localizers.azimuth import agreement

__all__ = ["Rule", "View", "excite", "mean_by_place", "product", "products"]


class View(NamedTuple):
    """What a place stores, and a query shows: its landmarks' signatures and azimuths.

    Shapes and units:
        signatures: float32 (points, size); or uint8, in 255ths of 1.
        azimuths: float32 (points,), radians in -pi..pi.
    """

    signatures: Float32[np.ndarray, "points size"] | UInt8[np.ndarray, "points size"]
    azimuths: Float32[np.ndarray, " points"]


class Rule(NamedTuple):
    """What makes a unit active.

    Attributes:
        threshold: the match below which two landmarks have nothing in common.
        width: of the Gaussian agreement of azimuths, radians.
        reach: azimuths further apart do not agree, radians.
    """

    threshold: float
    width: float
    reach: float


@njit(cache=True)
def product(recognised: np.float32, query: np.float32, unit: np.float32, width: float) -> np.float32:
    """What times where: the recognition of a pair, at most 1, times the agreement of its two azimuths."""
    return min(recognised, np.float32(1)) * agreement(query, unit, width)


@njit(cache=True)
def products(
    p: NDArray[np.int64],
    m: NDArray[np.int64],
    matches: NDArray[np.float32],
    queries: NDArray[np.float32],
    units: NDArray[np.float32],
    width: float,
    threshold: float,
) -> NDArray[np.float32]:
    """What times where of each pair: min(1, max(0, s - RT) / (1 - RT)) * agreement of azimuths."""
    found = np.zeros(len(matches), np.float32)
    scale = np.float32(1) - np.float32(threshold)
    for pair in range(len(matches)):
        recognised = (matches[pair] - np.float32(threshold)) / scale
        if recognised > 0:
            found[pair] = product(recognised, queries[p[pair]], units[m[pair]], width)
    return found


@njit(cache=True)
def excite(activity: NDArray[np.float32], m: NDArray[np.int64], found: NDArray[np.float32]) -> None:
    """Raise each unit's activity to the largest product of its pairs."""
    for pair in range(len(m)):
        activity[m[pair]] = max(activity[m[pair]], found[pair])


@njit(cache=True)
def mean_by_place(activity: NDArray[np.float32], starts: NDArray[np.int64]) -> NDArray[np.float32]:
    """The mean activity of each place's units, 0 where it has none."""
    responses = np.zeros(len(starts) - 1, np.float32)
    for place in range(len(responses)):
        first, end = starts[place], starts[place + 1]
        for unit in range(first, end):
            responses[place] += activity[unit]
        if end > first:
            responses[place] /= np.float32(end - first)
    return responses
