"""Exact search for the place that responds most to a query, which gives places up as soon as they cannot win.

A place is matched strip by strip, four rows of the query's regions at a time. No region can add more than its share,
1 / number of kept regions: a place is left once what it has and what it could still get is less than the best so far.

Two orders decide how soon that is, and neither what is found. Places are visited as their outlines resemble the
query's; strips are matched in the order of how much the first places visited missed in them.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int64
from numba import njit
from numpy.typing import NDArray

from vprbench_localizers.on_threads import on_threads
from vprbench_localizers.region_match import (
    CELLS,
    DIRECTIONS,
    REGIONS,
    Description,
    match_rows,
    room_to_match,
    total,
)

__all__ = ["OUTLINE_SIZE", "Found", "best_place", "outline"]

# Cells a side that an outline takes together (our choice: 2, 4 and 8 put the place that wins equally far in front).
COARSE = 8
OUTLINE_SIZE = (CELLS // COARSE) ** 2 * DIRECTIONS

# Rows of regions to a strip (our choice: with fewer, places are left earlier, but less work is shared between rows).
STRIP = 4
STRIPS = -(-REGIONS // STRIP)

# So many places are matched whole, to learn in which strips most is missed (our choice).
PROBES = 8

# More than rounding can add to a score.
SLACK = 1e-5


class Found(NamedTuple):
    """The place that responds most, and what it took to find it.

    Attributes:
        place: its index, the lowest of equal ones; -1 where there are no places.
        response: 0..1, bit by bit that of `score_places`.
        matched: share of the products of the query's kept regions with the places that were computed, 0..1.
    """

    place: int
    response: float
    matched: float


def outline(planes: Float32[np.ndarray, "32 288"]) -> Float32[np.ndarray, " 128"]:
    """The gradients of a frame in 4 x 4 fields, as a unit vector; square roots keep a few strong edges from ruling."""
    cells = np.sqrt(planes[:, : DIRECTIONS * CELLS])
    fields = cells.reshape(CELLS // COARSE, COARSE, DIRECTIONS, CELLS // COARSE, COARSE).mean(axis=(1, 4)).ravel()
    return fields / max(np.linalg.norm(fields), np.finfo(np.float32).tiny)


def best_place(
    query: Description,
    places: Float32[np.ndarray, "places 32 288"],
    outlines: Float32[np.ndarray, "places 128"],
    threads: int = 1,
) -> Found:
    """The first of the places to which `score_places` gives the highest score.

    Args:
        query: of which the kept regions are looked for.
        places: the planes of each place.
        outlines: the outline of each place.
        threads: at most so many search, each a part of the places.
    """
    visits = np.argsort(-(outlines @ outline(query.planes)), kind="stable")
    parts = [visits[first::threads] for first in range(min(threads, len(visits)))]
    found = on_threads(partial(_search, query, places), parts)
    best = max(found, key=lambda one: (one.response, -one.place), default=Found(-1, 0.0, 0.0))
    matched = sum(one.matched * len(part) for one, part in zip(found, parts, strict=True))
    return best._replace(matched=matched / max(len(visits), 1))


def _search(query: Description, places: Float32[np.ndarray, "places 32 288"], visits: Int64[np.ndarray, " n"]) -> Found:
    """The best of the places visited, of which there is at least one."""
    regions, share = _asked(query)
    place, response, matched = _visit(query, regions, share, places, visits)
    return Found(int(place), float(response), float(matched / max(len(visits) * regions.sum(), 1)))


def _asked(query: Description) -> tuple[Int64[np.ndarray, "8"], float]:
    """How many regions of each strip the query asks for, and the most that one of them can add to a score."""
    regions = [np.count_nonzero(query.weights[first : first + STRIP]) for first in range(0, REGIONS, STRIP)]
    inverse = query.planes[:, DIRECTIONS * CELLS :]
    shares = np.divide(query.weights, inverse, out=np.zeros((CELLS, CELLS)), where=inverse > 0)
    return np.array(regions), float(shares.max())


@njit(cache=True)
def _rows(strip: int) -> tuple[int, int]:
    """First row of a strip, and the first one after it."""
    return strip * STRIP, min(strip * STRIP + STRIP, REGIONS)


@njit(cache=True)
def _order(regions: NDArray[np.int64], most: float, probed: NDArray[np.float64]) -> NDArray[np.int64]:
    """Strips by how much was missed in them: the most that their regions can add, less what they did add."""
    missed = regions * most
    for strip in range(STRIPS):
        first, last = _rows(strip)
        missed[strip] -= probed[first:last].sum()
    return np.argsort(-missed)


@njit(cache=True, nogil=True)
def _visit(
    query: Description,
    regions: NDArray[np.int64],
    share: float,
    places: NDArray[np.float32],
    visits: NDArray[np.int64],
) -> tuple[int, np.float32, int]:
    """Index and score of the best place, and how many regions were matched in all."""
    query, buffers, shares = room_to_match(query)
    order, probed = np.arange(STRIPS), np.zeros(REGIONS)
    best, best_score, matched = -1, np.float32(0), 0
    for visit in range(len(visits)):
        k, reach = visits[visit], share * regions.sum()
        if visit < PROBES:
            match_rows(query, places[k], 0, REGIONS, buffers, shares)
            matched += regions.sum()
            probed += shares
            order = _order(regions, share * (visit + 1), probed)
        else:
            for strip in order:
                if reach + SLACK < best_score:
                    break
                first, last = _rows(int(strip))
                match_rows(query, places[k], first, last, buffers, shares)
                reach -= share * regions[strip] - shares[first:last].sum()
                matched += regions[strip]
        # A place that was left is out of reach; in the strips that were not matched its shares are another's.
        if reach + SLACK >= best_score:
            score = total(shares)
            if best < 0 or score > best_score or (score == best_score and k < best):
                best, best_score = k, score
    return best, best_score, matched
