"""A memory for codes of few values: only units that share a value with a query, in its direction, are looked at."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.types import Responses
from vprbench_localizers.azimuth import turn
from vprbench_localizers.growing import with_room
from vprbench_localizers.posting_lists import (
    SECTORS,
    Postings,
    empty_postings,
    list_of,
    packed,
    post,
    sector_of,
    with_room_for,
)
from vprbench_localizers.signature_size import require_size
from vprbench_localizers.unit_activity import Rule, View, mean_by_place, product

__all__ = ["OverlapMemory", "code_length"]

# Far above what float32 can do to the difference of two azimuths, radians.
ROUNDING = 1e-5


class OverlapMemory:
    """Places of units whose match is the overlap of their codes: 2 sum of shares / (L1(a) + L1(b)).

    What two values share is the smaller, if both have one sign. Values that one of both lacks add nothing, so that
    the lists of a query's own values have all that counts. Sums run in float32 from the first value to the last: the
    bits are those of an encoder that adds up all values in this order.

    Args:
        full: the number of places at which it lets go of the room that lists keep to grow; None: never.
    """

    def __init__(self, full: int | None = None) -> None:
        self._full = full
        self._places = self._units = self._entries = 0
        self._starts = np.zeros(1, np.int64)
        self._lengths, self._azimuths = np.empty((2, 0), np.float32)
        self._postings = empty_postings(0)

    def __len__(self) -> int:
        return self._places

    def add(self, view: View) -> int:
        """Store a place; its index. A place without landmarks has no unit.

        Raises:
            PluginError: its signatures are of another size than those stored.
        """
        first, end = self._units, self._units + len(view.azimuths)
        if end > first:
            self._reserve(end, view)
            _measure(view.signatures, self._lengths[first:end])
            self._azimuths[first:end] = view.azimuths
            self._entries = post(self._postings, self._entries, view.signatures, view.azimuths, first)
        self._units, self._places = end, self._places + 1
        self._starts = with_room(self._starts, self._places + 1, self._places)
        self._starts[self._places] = end
        if self._places == self._full:
            self._postings = packed(self._postings)
            self._entries = len(self._postings.units)
        return self._places - 1

    def respond(self, query: View, rule: Rule) -> Responses:
        """Response 0..1 of every place."""
        activity = np.zeros(self._units, np.float32)
        if self._units and len(query.azimuths):
            self._must_have_size(query)
            units = self._lengths[: self._units], self._azimuths[: self._units]
            _excite(activity, query.signatures, query.azimuths, self._postings, *units, *rule)
        return mean_by_place(activity, self._starts[: self._places + 1])

    def _reserve(self, units: int, view: View) -> None:
        if not self._units:
            self._postings = empty_postings(view.signatures.shape[1])
        self._must_have_size(view)
        self._lengths, self._azimuths = (with_room(a, units, self._units) for a in (self._lengths, self._azimuths))
        self._postings = with_room_for(self._postings, self._entries, view.signatures, view.azimuths)

    def _must_have_size(self, view: View) -> None:
        require_size(view.signatures.shape[1], len(self._postings.starts) // 2)


@njit(cache=True)
def code_length(signature: NDArray[np.float32]) -> np.float32:
    """L1 of a signature; 1 of one that is zero throughout, see `Postings`."""
    length = np.float32(0)
    for value in signature:
        length += abs(value)
    return length if length > 0 else np.float32(1)


@njit(cache=True)
def _measure(signatures: NDArray[np.float32], lengths: NDArray[np.float32]) -> None:
    for row in range(len(signatures)):
        lengths[row] = code_length(signatures[row])


@njit(cache=True)
def _excite(
    activity: NDArray[np.float32],
    queries: NDArray[np.float32],
    query_azimuths: NDArray[np.float32],
    postings: Postings,
    lengths: NDArray[np.float32],
    azimuths: NDArray[np.float32],
    threshold: float,
    width: float,
    reach: float,
) -> None:
    """Set each unit's activity: max over queries of min(1, max(0, s - RT) / (1 - RT)) * agreement of azimuths."""
    common = np.zeros(len(activity), np.float32)
    # One more than can be met, as the place that is written to next.
    met = np.empty(len(activity) + 1, np.uint32)
    scale = np.float32(1) - np.float32(threshold)
    for p in range(len(queries)):
        azimuth, length = query_azimuths[p], code_length(queries[p])
        for k in range(_meet(queries[p], azimuth, reach, postings, common, met)):
            m = met[k]
            match = np.float32(2) * common[m] / (length + lengths[m])
            common[m] = 0
            recognised = (match - np.float32(threshold)) / scale
            # An activity above the recognition is above its product with any agreement.
            if recognised > activity[m] and turn(azimuth, azimuths[m]) <= reach:
                activity[m] = max(activity[m], product(recognised, azimuth, azimuths[m], width))


@njit(cache=True)
def _meet(
    query: NDArray[np.float32],
    azimuth: np.float32,
    reach: float,
    postings: Postings,
    common: NDArray[np.float32],
    met: NDArray[np.uint32],
) -> int:
    """Add to `common` what each unit about this direction shares with a query; write those to `met`: how many."""
    first = sector_of(azimuth - min(reach, np.pi) - ROUNDING)
    last = min(sector_of(azimuth + min(reach, np.pi) + ROUNDING), first + SECTORS - 1)
    count, zero = 0, True
    for i in range(len(query)):
        if query[i] != 0:
            zero = False
            for sector in range(first, last + 1):
                at = list_of(i, query[i]), sector % SECTORS
                count = _collect(abs(query[i]), at, postings, common, met, count)
    if zero:
        for sector in range(first, last + 1):
            at = list_of(len(query), np.float32(1)), sector % SECTORS
            count = _collect(np.float32(1), at, postings, common, met, count)
    return count


@njit(cache=True)
def _collect(
    value: np.float32,
    at: tuple[int, int],
    postings: Postings,
    common: NDArray[np.float32],
    met: NDArray[np.uint32],
    count: int,
) -> int:
    """Add what the units of one list share with a value."""
    start, entries = postings.starts[at], postings.counts[at]
    units, values = postings.units[start : start + entries], postings.values[start : start + entries]
    for entry in range(entries):
        m = units[entry]
        # Without a branch: whether a unit is met for the first time is a coin toss.
        met[count] = m
        count += common[m] == 0
        common[m] += min(value, values[entry])
    return count
