"""Which units use a value and stand in a direction: lists that only ever grow at their end.

A signature of n values is listed under each of its values that is not zero, positive and negative ones apart, in the
sector that its azimuth lies in. A list is a chain of blocks, the newest first; all but the newest are full.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int32, UInt32
from numba import njit
from numpy.typing import NDArray

from vprbench_localizers.growing import with_room

__all__ = ["BLOCK", "SECTORS", "Postings", "empty_postings", "list_of", "post", "sector_of", "with_room_for"]

# Of 10 degrees each (our choice): finer ones are read less beyond the reach, but make more lists.
SECTORS = 36

# Entries of a block (our choice): longer ones wait less for memory, but leave more of it unused.
BLOCK = 16


class Postings(NamedTuple):
    """The lists, in rows as `list_of` says and columns by sector, and the blocks that they are made of.

    Signatures of which every value is zero are listed as if they had a 1 at position n, where no other has anything.

    Shapes:
        newest: int32 (2 n + 1, sectors), the first block of each list; -1 where it is empty.
        filled: int32 (2 n + 1, sectors), how many entries that block has.
        older: int32 (blocks,), the block that follows; -1 after the last.
        units: uint32 (blocks, entries), who uses the value ...
        values: float32 (blocks, entries), ... and its amount.
    """

    newest: Int32[np.ndarray, "lists sectors"]
    filled: Int32[np.ndarray, "lists sectors"]
    older: Int32[np.ndarray, " blocks"]
    units: UInt32[np.ndarray, "blocks entries"]
    values: Float32[np.ndarray, "blocks entries"]


def empty_postings(size: int) -> Postings:
    """Lists for signatures of so many values."""
    lists = 2 * size + 1, SECTORS
    newest, filled = np.full(lists, -1, np.int32), np.full(lists, BLOCK, np.int32)
    older, units, values = np.empty(0, np.int32), np.empty((0, BLOCK), np.uint32), np.empty((0, BLOCK), np.float32)
    return Postings(newest, filled, older, units, values)


def with_room_for(postings: Postings, blocks: int, used: int) -> Postings:
    """The same lists, of which `used` blocks are in use, with room for so many."""
    grown = (with_room(array, blocks, used) for array in postings[2:])
    return Postings(postings.newest, postings.filled, *grown)


@njit(cache=True)
def sector_of(azimuth: np.float32 | float) -> int:
    """The sector of an azimuth in -pi..pi, or how many sectors beyond the first or last one it is."""
    return int(np.floor((azimuth + np.pi) * (SECTORS / (2 * np.pi))))


@njit(cache=True)
def list_of(position: int, value: np.float32) -> int:
    """The row of lists of a value at this position of a signature: another for negative ones."""
    return 2 * position + int(value < 0)


@njit(cache=True)
def post(
    postings: Postings,
    used: int,
    signatures: NDArray[np.float32],
    azimuths: NDArray[np.float32],
    first: int,
) -> int:
    """List signatures as those of the units from `first` on; how many blocks are now in use, at most one an entry."""
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
    block, entry = postings.newest[at], postings.filled[at]
    if entry == BLOCK:
        postings.older[used] = block
        block, entry, used = np.int32(used), np.int32(0), used + 1
        postings.newest[at] = block
    postings.units[block, entry], postings.values[block, entry] = unit, amount
    postings.filled[at] = entry + 1
    return used
