"""The region match of CoHOG: mean over a query's kept regions of the best cosine with any region of a place.

A region is 2x2 cells, so with C the products of query cells and place cells, the product of two regions is
C(upper left) + C(lower left) + C(upper right) + C(lower right). Neighbouring regions share their columns of two
cells: each column's sum is computed once, which halves the work of multiplying 32-value descriptors, and neither
the descriptors nor their 961 x 961 products are ever stored.

Cells and regions share one index, row by row, 32 to a row; a region has that of its upper right cell:

    cell (i, j)   at 32 i + j       +------+------+
    region (i, j) at 32 i + j + 1   |    n | n+1  | <- here stands the region of these four cells
                                    +------+------+
                                    | n+32 | n+33 |
                                    +------+------+

In the scan over n + 1 the column of n + 1 and n + 33 completes that region, then opens the next one to the right.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float32, Float64
from llvmlite import ir  # type: ignore[import-untyped]
from numba import njit
from numba.extending import intrinsic
from numpy.typing import NDArray

from vprbench_localizers.on_threads import on_threads

__all__ = [
    "PLANES_SHAPE",
    "STRIPS",
    "Description",
    "describe_regions",
    "match_strip",
    "score_places",
    "share_buffers",
    "total",
]

CELLS = 32  # a side
REGIONS = CELLS - 1
STRIPS = CELLS // 2  # of two rows of regions, which are matched together; the last row of the last is empty
# A last row of empty cells lets the regions' rows be taken two by two.
LENGTH = (CELLS + 1) * CELLS
# Place cells that are the upper ones of a region.
UPPER = REGIONS * CELLS
PLANES_SHAPE = (9, LENGTH)

# The eight values of one cell.
Cell = tuple[np.float32, np.float32, np.float32, np.float32, np.float32, np.float32, np.float32, np.float32]


class Description(NamedTuple):
    """All that CoHOG keeps of a frame.

    Region (i, j) has its numbers at position 32 i + j + 1, that of its upper right cell; the first column is zero.

    Shapes:
        planes: float32 (9, 1056): eight values of each cell, row by row; then each region's 1 / |descriptor|.
        weights: float32 (1056,): 1 / |descriptor| / number of kept regions, zero where a region is not kept.
    """

    planes: Float32[np.ndarray, "9 1056"]
    weights: Float32[np.ndarray, " 1056"]


def describe_regions(cells: Float64[np.ndarray, "32 32 8"], kept: Bool[np.ndarray, "31 31"]) -> Description:
    """The description of a frame with these cell histograms, of which these regions ask when it is the query.

    A region without any gradient has the descriptor zero, so it matches nothing.
    """
    squares = np.square(cells).sum(axis=2)
    norms = np.sqrt(squares[:-1, :-1] + squares[:-1, 1:] + squares[1:, :-1] + squares[1:, 1:])
    inverse = np.divide(1.0, norms, out=np.zeros_like(norms), where=norms > 0)
    planes = np.zeros((9, CELLS + 1, CELLS), np.float32)
    planes[:8, :CELLS] = np.moveaxis(cells, 2, 0)
    planes[8, :REGIONS, 1:] = inverse
    weights = np.zeros((CELLS + 1, CELLS), np.float32)
    weights[:REGIONS, 1:] = inverse * kept / max(np.count_nonzero(kept), 1)
    return Description(planes.reshape(9, LENGTH), weights.reshape(LENGTH))


def score_places(
    query: Description,
    places: Float32[np.ndarray, "places 9 1056"],
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
    on_threads(lambda span: _score(query.planes, query.weights, places[span], scores[span]), spans)


def _maximum(_typing: Any, a: Any, _b: Any) -> Any:  # noqa: ANN401 - numba's own types are untyped
    """The larger of two floats as one instruction: LLVM puts no loop into vector lanes that calls numba's max."""

    def generate(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:  # noqa: ANN401
        kind = args[0].type
        maximum = builder.module.declare_intrinsic("llvm.maxnum", [kind], ir.FunctionType(kind, [kind, kind]))
        return builder.call(maximum, args, fastmath=("fast",))

    return a(a, a), generate


_larger: Any = intrinsic(_maximum)


@njit(cache=True)
def _cell(planes: NDArray[np.float32], at: int) -> Cell:
    """The eight values of a cell, as scalars that stay in registers."""
    return (
        planes[0, at],
        planes[1, at],
        planes[2, at],
        planes[3, at],
        planes[4, at],
        planes[5, at],
        planes[6, at],
        planes[7, at],
    )


@njit(cache=True, fastmath=True)
def _product(cell: Cell, planes: NDArray[np.float32], at: int) -> np.float32:
    """The dot product of a cell and the cell of `planes` at a position."""
    return (
        cell[0] * planes[0, at]
        + cell[1] * planes[1, at]
        + cell[2] * planes[2, at]
        + cell[3] * planes[3, at]
        + cell[4] * planes[4, at]
        + cell[5] * planes[5, at]
        + cell[6] * planes[6, at]
        + cell[7] * planes[7, at]
    )


@njit(cache=True, fastmath=True)
def _best_pair(
    query: NDArray[np.float32],
    at: int,
    place: NDArray[np.float32],
    left: NDArray[np.float32],
    right: NDArray[np.float32],
) -> tuple[np.float32, np.float32]:
    """Best product with any region of a place, of the regions whose upper right cell is `at` and the one below it.

    `left` holds the sums of the column of cells to the left, for both regions, each at the position to the right
    of its own; those of this column are written to `right`. The caller then swaps the two, since this column is
    the left one of the next regions.
    """
    top, middle, bottom = _cell(query, at), _cell(query, at + CELLS), _cell(query, at + 2 * CELLS)
    upper_best, lower_best = np.float32(0), np.float32(0)
    for x in range(UPPER):
        upper = _product(top, place, x) + _product(middle, place, x + CELLS)
        lower = _product(middle, place, x) + _product(bottom, place, x + CELLS)
        upper_best = _larger(upper_best, (left[0, x] + upper) * place[8, x])
        lower_best = _larger(lower_best, (left[1, x] + lower) * place[8, x])
        right[0, x + 1] = upper
        right[1, x + 1] = lower
    return upper_best, lower_best


@njit(cache=True, fastmath=True)
def match_strip(
    query: NDArray[np.float32],
    weights: NDArray[np.float32],
    place: NDArray[np.float32],
    strip: int,
    columns: tuple[NDArray[np.float32], NDArray[np.float32]],
    shares: NDArray[np.float32],
) -> None:
    """Write to `shares`, of two rows of regions, what each column of two adds to the score; see `share_buffers`."""
    left, right = columns
    for column in range(CELLS):
        at = 2 * strip * CELLS + column
        upper, lower = weights[at], weights[at + CELLS]
        share = np.float32(0)
        if upper or lower or weights[at + 1] or weights[at + 1 + CELLS]:
            best = _best_pair(query, at, place, left, right)
            share = upper * best[0] + lower * best[1]
            left, right = right, left
        shares[strip, column] = share


@njit(cache=True)
def total(shares: NDArray[np.float32]) -> np.float32:
    """The score that the shares of all regions make, added up in an order that does not depend on who asks."""
    score = 0.0
    for strip in range(STRIPS):
        for column in range(CELLS):
            score += shares[strip, column]
    return np.float32(min(score, 1.0))


@njit(cache=True)
def share_buffers() -> tuple[tuple[NDArray[np.float32], NDArray[np.float32]], NDArray[np.float32]]:
    """Room for the sums of two columns, and for the shares of every strip."""
    columns = np.zeros((2, LENGTH), np.float32), np.zeros((2, LENGTH), np.float32)
    return columns, np.zeros((STRIPS, CELLS), np.float32)


@njit(cache=True, nogil=True)
def _score(
    query: NDArray[np.float32], weights: NDArray[np.float32], places: NDArray[np.float32], scores: NDArray[np.float32]
) -> None:
    columns, shares = share_buffers()
    for k in range(len(places)):
        for strip in range(STRIPS):
            match_strip(query, weights, places[k], strip, columns, shares)
        scores[k] = total(shares)
