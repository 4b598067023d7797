"""Responses of chosen places by the overlap of sparse codes, bitwise those of `OverlapMemory`.

That one reads lists of the places that share a value with a query. Here places are chosen, and each of their units is
compared with all of the query's landmarks at once, a vector of them for each of its own few values.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Int64
from numba import njit
from numpy.typing import NDArray

from vprbench.types import Responses
from vprbench_localizers.azimuth import turn
from vprbench_localizers.overlap_memory import code_length
from vprbench_localizers.posting_lists import list_of
from vprbench_localizers.sparse_views import SparseUnits
from vprbench_localizers.unit_activity import Rule, View, mean_by_place, product

__all__ = ["overlap_responses"]


def overlap_responses(query: View, units: SparseUnits, places: Int64[np.ndarray, " chosen"], rule: Rule) -> Responses:
    """Response 0..1 of each chosen place to a query, both of codes of the same size."""
    starts = _starts(units.place_ends, places)
    lengths = np.array([code_length(signature) for signature in query.signatures], np.float32)
    activity = _activity(_amounts(query.signatures), lengths, query.azimuths, units, places, starts, *rule)
    return mean_by_place(activity, starts)


def _amounts(signatures: Float32[np.ndarray, "points size"]) -> Float32[np.ndarray, "lists points"]:
    """What each landmark has of each value, in rows as in `Postings`: codes of nothing have a 1 at the end."""
    points, size = signatures.shape
    amounts = np.zeros((2 * size + 1, points), np.float32)
    amounts[:-1:2], amounts[1::2] = np.maximum(signatures.T, 0), np.maximum(-signatures.T, 0)
    amounts[-1] = ~signatures.any(axis=1)
    return amounts


@njit(cache=True)
def _starts(place_ends: NDArray[np.int64], places: NDArray[np.int64]) -> NDArray[np.int64]:
    """Where the units of each chosen place begin, and the last end, if they stood in a row."""
    starts = np.zeros(len(places) + 1, np.int64)
    for chosen in range(len(places)):
        place = places[chosen]
        first = place_ends[place - 1] if place else 0
        starts[chosen + 1] = starts[chosen] + place_ends[place] - first
    return starts


@njit(cache=True)
def _activity(
    amounts: NDArray[np.float32],
    lengths: NDArray[np.float32],
    azimuths: NDArray[np.float32],
    units: SparseUnits,
    places: NDArray[np.int64],
    starts: NDArray[np.int64],
    threshold: float,
    width: float,
    reach: float,
) -> NDArray[np.float32]:
    """Each unit's activity: max over landmarks of min(1, max(0, s - RT) / (1 - RT)) * agreement of azimuths."""
    activity, recognised = np.zeros(starts[-1], np.float32), np.empty(len(lengths), np.float32)
    for chosen in range(len(places)):
        ahead = units.place_ends[places[chosen]] - starts[chosen + 1]
        for at in range(starts[chosen], starts[chosen + 1]):
            azimuth = units.azimuths[ahead + at]
            _recognise(recognised, amounts, lengths, units, ahead + at, np.float32(threshold))
            for p in range(len(recognised)):
                # By itself, since it runs in vector lanes, where a branch on each turn would not.
                recognised[p] = recognised[p] if turn(azimuths[p], azimuth) <= reach else np.float32(0)
            for p in range(len(recognised)):
                # An activity above the recognition is above its product with any agreement.
                if recognised[p] > activity[at]:
                    activity[at] = max(activity[at], product(recognised[p], azimuths[p], azimuth, width))
    return activity


# A division that first looks for a zero would not run in vector lanes.
@njit(cache=True, error_model="numpy")
def _recognise(
    recognised: NDArray[np.float32],
    amounts: NDArray[np.float32],
    lengths: NDArray[np.float32],
    units: SparseUnits,
    unit: int,
    threshold: np.float32,
) -> None:
    """How far each landmark's match with a unit lies above the threshold, (s - RT) / (1 - RT)."""
    first, end = (units.unit_ends[unit - 1] if unit else 0), units.unit_ends[unit]
    for p in range(len(recognised)):
        recognised[p] = amounts[-1, p] if first == end else np.float32(0)
    for entry in range(first, end):
        value = units.values[entry]
        row, amount = amounts[list_of(units.columns[entry], value)], abs(value)
        for p in range(len(recognised)):
            recognised[p] += min(row[p], amount)
    length, scale = code_length(units.values[first:end]), np.float32(1) - threshold
    for p in range(len(recognised)):
        match = np.float32(2) * recognised[p] / (lengths[p] + length)
        recognised[p] = (match - threshold) / scale
