"""The region match of CoHOG: mean over a query's kept regions of the best cosine with any region of a place.

A region is 2x2 cells. With C(i, j; k, l) the product of the query's cell in row i, column j and the place's in row k,
column l, the product of the regions that have them as their upper left cells is

    C(i, j; k, l) + C(i+1, j; k+1, l) + C(i, j+1; k, l+1) + C(i+1, j+1; k+1, l+1)

so each C serves four pairs of regions. It is computed once: the products of a row of the query's cells with a row of
the place's are a block of 32 x 32. Down a diagonal (i+1, k+1) each block is added to the one before, which makes the
first two terms; the last two are those sums again, one place cell and one query cell on. Neither the descriptors nor
their 961 x 961 products are ever stored: a block and its sums are 8 kB, and stay in the nearest cache.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float32, Float64
from numba import njit
from numpy.typing import NDArray

from vprbench_localizers.on_threads import on_threads
from vprbench_localizers.wide_vectors import use_wide_vectors

__all__ = [
    "CELLS",
    "DIRECTIONS",
    "PLANES_SHAPE",
    "REGIONS",
    "Buffers",
    "Description",
    "describe_regions",
    "match_rows",
    "room_to_match",
    "score_places",
    "total",
]

CELLS = 32  # a side
REGIONS = CELLS - 1
DIRECTIONS = 8
# A row of cells: its values of each direction, then 1 / |descriptor| of the regions that have it as their upper cells.
PLANES_SHAPE = (CELLS, (DIRECTIONS + 1) * CELLS)
INVERSES = DIRECTIONS * CELLS
BLOCK = CELLS * CELLS
# Sums begin half a block behind the products: a processor first tells addresses apart by their last 12 bits, so that a
# load waits for a store a whole block of 4096 bytes away.
SUMS = BLOCK + BLOCK // 2
# Values to a line of the cache, and to the widest vector.
LINE = 16

# Sums are taken in the order written, wherever a kernel is inlined: responses must not depend on who asks. Nothing
# here is negative, infinite or not a number, without which the maximum would not be one instruction.
EXACT = {"contract", "nnan", "nsz"}

# The eight values of one cell.
Cell = tuple[np.float32, np.float32, np.float32, np.float32, np.float32, np.float32, np.float32, np.float32]


class Description(NamedTuple):
    """All that CoHOG keeps of a frame.

    Region (i, j) has its numbers where its upper left cell is; the last row and column of regions are zero.

    Shapes:
        planes: float32 (32, 288): of each row of cells 32 values of each of 8 directions; then 1 / |descriptor|.
        weights: float32 (32, 32): 1 / |descriptor| / number of kept regions, zero where a region is not kept.
    """

    planes: Float32[np.ndarray, "32 288"]
    weights: Float32[np.ndarray, "32 32"]


class Buffers(NamedTuple):
    """Room for one match at a time.

    Shapes:
        products: (1024,): of a row of the query's cells with a row of the place's, 32 to each cell of the place.
        sums: (1057,): those of two rows with the products of the next two; the rest is read, and does not count.
        best: (31, 32): the best product of each region of the query with any of the place, at its upper left cell.
    """

    products: Float32[np.ndarray, " 1024"]
    sums: Float32[np.ndarray, " 1057"]
    best: Float32[np.ndarray, "31 32"]


def describe_regions(cells: Float64[np.ndarray, "32 32 8"], kept: Bool[np.ndarray, "31 31"]) -> Description:
    """The description of a frame with these cell histograms, of which these regions ask when it is the query.

    A region without any gradient has the descriptor zero, so it matches nothing.
    """
    squares = np.square(cells).sum(axis=2)
    norms = np.sqrt(squares[:-1, :-1] + squares[:-1, 1:] + squares[1:, :-1] + squares[1:, 1:])
    inverse = np.divide(1.0, norms, out=np.zeros_like(norms), where=norms > 0)
    planes = np.zeros((CELLS, DIRECTIONS + 1, CELLS), np.float32)
    planes[:, :DIRECTIONS] = np.moveaxis(cells, 2, 1)
    planes[:REGIONS, DIRECTIONS, :REGIONS] = inverse
    weights = np.zeros((CELLS, CELLS), np.float32)
    weights[:REGIONS, :REGIONS] = inverse * kept / max(np.count_nonzero(kept), 1)
    return Description(planes.reshape(PLANES_SHAPE), weights)


def score_places(
    query: Description,
    places: Float32[np.ndarray, "places 32 288"],
    scores: Float32[np.ndarray, " places"],
    threads: int = 1,
) -> None:
    """Write the score 0..1 of each place; each depends on the query and that place alone, bit by bit.

    Args:
        query: of which the kept regions are looked for.
        places: the planes of each place.
        scores: is filled.
        threads: at most so many share the places between them.
    """
    share = -(-len(places) // threads)
    firsts = range(0, len(places), max(share, 1))
    spans = [slice(first, first + share) for first in firsts]
    on_threads(lambda span: _score(query, places[span], scores[span]), spans)


@njit(cache=True)
def _cell(row: NDArray[np.float32], at: int) -> Cell:
    """The eight values of a cell, as scalars that stay in registers."""
    return (
        row[at],
        row[CELLS + at],
        row[2 * CELLS + at],
        row[3 * CELLS + at],
        row[4 * CELLS + at],
        row[5 * CELLS + at],
        row[6 * CELLS + at],
        row[7 * CELLS + at],
    )


@njit(cache=True, fastmath=False)
def _rounded(value: np.float32, other: np.float32) -> np.float32:
    """A product that is rounded before anything is added to it.

    Without it either of the first two terms of `_product` could be the one that is not, as LLVM likes.
    """
    return value * other


@njit(cache=True, fastmath=EXACT)
def _product(cell: Cell, row: NDArray[np.float32], at: int) -> np.float32:
    """The dot product of a cell and the cell of `row` at a column."""
    return (
        cell[0] * row[at]
        + _rounded(cell[1], row[CELLS + at])
        + cell[2] * row[2 * CELLS + at]
        + cell[3] * row[3 * CELLS + at]
        + cell[4] * row[4 * CELLS + at]
        + cell[5] * row[5 * CELLS + at]
        + cell[6] * row[6 * CELLS + at]
        + cell[7] * row[7 * CELLS + at]
    )


@njit(cache=True, fastmath=EXACT)
def _multiply(
    query: NDArray[np.float32], place: NDArray[np.float32], products: NDArray[np.float32], sums: NDArray[np.float32]
) -> None:
    """Put the products of two rows of cells into `products`, and into `sums` their sums with what was there.

    Two cells of the place are taken at a time, so that each value of the query, once loaded, serves twice.
    """
    use_wide_vectors()
    for at in range(0, CELLS, 2):
        cell, other = _cell(place, at), _cell(place, at + 1)
        for column in range(CELLS):
            x = CELLS * at + column
            product, other_product = _product(cell, query, column), _product(other, query, column)
            sums[x] = products[x] + product
            sums[x + CELLS] = products[x + CELLS] + other_product
            products[x] = product
            products[x + CELLS] = other_product


@njit(cache=True, fastmath=EXACT)
def _compare(sums: NDArray[np.float32], place: NDArray[np.float32], best: NDArray[np.float32]) -> None:
    """Raise `best` of a row of the query's regions to their products with a row of the place's, four at a time.

    The place's last region is none; its 1 / |descriptor| is zero.
    """
    use_wide_vectors()
    for at in range(0, CELLS, 4):
        inverse = place[INVERSES + at], place[INVERSES + at + 1], place[INVERSES + at + 2], place[INVERSES + at + 3]
        for column in range(CELLS):
            x = CELLS * at + column
            first = (sums[x] + sums[x + CELLS + 1]) * inverse[0]
            second = (sums[x + CELLS] + sums[x + 2 * CELLS + 1]) * inverse[1]
            third = (sums[x + 2 * CELLS] + sums[x + 3 * CELLS + 1]) * inverse[2]
            fourth = (sums[x + 3 * CELLS] + sums[x + 4 * CELLS + 1]) * inverse[3]
            best[column] = max(first, second, third, fourth, best[column])


@njit(cache=True)
def _share(weights: NDArray[np.float32], best: NDArray[np.float32]) -> float:
    """What a row of regions adds to the score; the last column is no region, and counts nothing."""
    share = 0.0
    for column in range(REGIONS):
        share += weights[column] * best[column]
    return share


@njit(cache=True)
def match_rows(
    query: Description,
    place: NDArray[np.float32],
    first: int,
    last: int,
    buffers: Buffers,
    shares: NDArray[np.float64],
) -> None:
    """Write to `shares` what each row first..last - 1 of the query's regions adds to the score of a place."""
    products, sums, best = buffers
    best[first:last] = 0
    for shift in range(1 - last, REGIONS - first):
        start, end = max(first, -shift), min(last, REGIONS - shift)
        _multiply(query.planes[start], place[start + shift], products, sums)
        for row in range(start, end):
            _multiply(query.planes[row + 1], place[row + 1 + shift], products, sums)
            _compare(sums, place[row + shift], best[row])
    for row in range(first, last):
        shares[row] = _share(query.weights[row], best[row])


@njit(cache=True)
def total(shares: NDArray[np.float64]) -> np.float32:
    """The score that the shares of all rows make, added up in an order that does not depend on who asks."""
    score = 0.0
    for row in range(REGIONS):
        score += shares[row]
    return np.float32(min(score, 1.0))


@njit(cache=True)
def _zeros(size: int) -> NDArray[np.float32]:
    """Zeros that begin where a line of the cache does, so that no vector of them touches two."""
    room = np.zeros(size + LINE, np.float32)
    skipped = -(room.ctypes.data // room.itemsize) % LINE
    return room[skipped : skipped + size]


@njit(cache=True)
def room_to_match(query: Description) -> tuple[Description, Buffers, NDArray[np.float64]]:
    """The query where each vector lies in one line of the cache; buffers; room for the share of every row."""
    planes = _zeros(query.planes.size).reshape(query.planes.shape)
    # numba takes seconds to compile `planes[:] = query.planes`.
    for at, value in np.ndenumerate(query.planes):
        planes[at] = value
    room = _zeros(SUMS + BLOCK + CELLS + 1)
    buffers = Buffers(room[:BLOCK], room[SUMS:], _zeros(REGIONS * CELLS).reshape(REGIONS, CELLS))
    return Description(planes, query.weights), buffers, np.zeros(REGIONS)


@njit(cache=True, nogil=True)
def _score(query: Description, places: NDArray[np.float32], scores: NDArray[np.float32]) -> None:
    query, buffers, shares = room_to_match(query)
    for k in range(len(places)):
        match_rows(query, places[k], 0, REGIONS, buffers, shares)
        scores[k] = total(shares)
