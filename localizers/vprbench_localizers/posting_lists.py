"""Which units use a value and stand in a direction: lists that only ever grow at their end.

A signature of n values is listed under each of its values that is not zero, positive and negative ones apart, in the
sector that its azimuth lies in. A list lies in one piece, so that reading it never waits for where it goes on; one that
is full moves to the end of all, with twice the room, and leaves its old place unused. About a fifth of the room is in
use; once nothing is to come, lists can be packed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int64, UInt32
from numba import njit
from numpy.typing import NDArray

from vprbench_localizers.growing import with_room

__all__ = ["SECTORS", "Postings", "empty_postings", "list_of", "packed", "post", "sector_of", "with_room_for"]

# Of 10 degrees each (our choice): finer ones are read less beyond the reach, but make more lists.
SECTORS = 36

# Entries for which a list has room at first (our choice).
FIRST_ROOM = 4


class Postings(NamedTuple):
    """The lists, in rows as `list_of` says and columns by sector, and the entries that they are made of.

    Signatures of which every value is zero are listed as if they had a 1 at position n, where no other has anything.

    Shapes:
        starts: int64 (2 n + 1, sectors), the first entry of each list.
        counts: int64 (2 n + 1, sectors), how many entries it has ...
        rooms: int64 (2 n + 1, sectors), ... and for how many there is room.
        units: uint32 (entries,), who uses the value ...
        values: float32 (entries,), ... and its amount.
    """

    starts: Int64[np.ndarray, "lists sectors"]
    counts: Int64[np.ndarray, "lists sectors"]
    rooms: Int64[np.ndarray, "lists sectors"]
    units: UInt32[np.ndarray, " entries"]
    values: Float32[np.ndarray, " entries"]


def empty_postings(size: int) -> Postings:
    """Lists for signatures of so many values."""
    starts, counts, rooms = np.zeros((3, 2 * size + 1, SECTORS), np.int64)
    return Postings(starts, counts, rooms, np.empty(0, np.uint32), np.empty(0, np.float32))


def with_room_for(
    postings: Postings, used: int, signatures: Float32[np.ndarray, "rows size"], azimuths: Float32[np.ndarray, " rows"]
) -> Postings:
    """The same lists, which use so many entries, with room for what `post` may add."""
    wanted = used + _most_added(postings, signatures, azimuths)
    units, values = with_room(postings.units, wanted, used), with_room(postings.values, wanted, used)
    return postings._replace(units=units, values=values)


def packed(postings: Postings) -> Postings:
    """The same lists one after another, without room between them; those that grow again move to the end."""
    ends = np.cumsum(postings.counts).reshape(postings.counts.shape)
    starts, entries = ends - postings.counts, int(ends[-1, -1])
    units, values = np.empty(entries, np.uint32), np.empty(entries, np.float32)
    _copy_lists(postings, starts, units, values)
    return Postings(starts, postings.counts, postings.counts.copy(), units, values)


@njit(cache=True)
def sector_of(azimuth: np.float32 | float) -> int:
    """The sector of an azimuth in -pi..pi, or how many sectors beyond the first or last one it is."""
    return int(np.floor((azimuth + np.pi) * (SECTORS / (2 * np.pi))))


@njit(cache=True)
def list_of(position: int, value: np.float32) -> int:
    """The row of lists of a value at this position of a signature: another for negative ones."""
    return 2 * position + int(value < 0)


@njit(cache=True)
def _most_added(postings: Postings, signatures: NDArray[np.float32], azimuths: NDArray[np.float32]) -> int:
    """Entries that lists may need at their new places, if each value finds its own full."""
    most = 0
    for row in range(len(signatures)):
        sector = sector_of(azimuths[row]) % SECTORS
        most += 2 * max(postings.rooms[list_of(signatures.shape[1], np.float32(1)), sector], FIRST_ROOM)
        for i in range(signatures.shape[1]):
            if signatures[row, i] != 0:
                most += 2 * max(postings.rooms[list_of(i, signatures[row, i]), sector], FIRST_ROOM)
    return most


@njit(cache=True)
def post(
    postings: Postings,
    used: int,
    signatures: NDArray[np.float32],
    azimuths: NDArray[np.float32],
    first: int,
) -> int:
    """List signatures as those of the units from `first` on; how many entries are then in use, or were left behind."""
    size = signatures.shape[1]
    for row in range(len(signatures)):
        sector = sector_of(azimuths[row]) % SECTORS
        zero = True
        for i in range(size):
            value = signatures[row, i]
            if value != 0:
                used = _append(postings, used, (list_of(i, value), sector), first + row, abs(value))
                zero = False
        if zero:
            one = np.float32(1)
            used = _append(postings, used, (list_of(size, one), sector), first + row, one)
    return used


@njit(cache=True)
def _append(postings: Postings, used: int, at: tuple[int, int], unit: int, amount: np.float32) -> int:
    start, count, room = postings.starts[at], postings.counts[at], postings.rooms[at]
    if count == room:
        postings.units[used : used + count] = postings.units[start : start + count]
        postings.values[used : used + count] = postings.values[start : start + count]
        start, room = used, max(2 * room, FIRST_ROOM)
        postings.starts[at], postings.rooms[at], used = start, room, used + room
    postings.units[start + count], postings.values[start + count] = unit, amount
    postings.counts[at] = count + 1
    return used


@njit(cache=True)
def _copy_lists(
    postings: Postings, starts: NDArray[np.int64], units: NDArray[np.uint32], values: NDArray[np.float32]
) -> None:
    for row in range(starts.shape[0]):
        for sector in range(starts.shape[1]):
            count, old, new = postings.counts[row, sector], postings.starts[row, sector], starts[row, sector]
            units[new : new + count] = postings.units[old : old + count]
            values[new : new + count] = postings.values[old : old + count]
