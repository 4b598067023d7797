"""Timing by turns: in each round every subject once, in an order drawn anew, so that a busy machine falls on all."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import sqrt

import numpy as np

from vprbench.frequency.stopwatch import Visit, lap, no_collection, visit
from vprbench.frequency.subjects import Subject
from vprbench.reporting import Report, silent
from vprbench.threads import one_thread
from vprbench.types import Observation

__all__ = ["MOST_QUERIES", "SLICE_SECONDS", "play_rounds", "queries_a_visit", "round_queries"]

# A visit gets as many queries as fit in the slice, but at least one and at most so many.
SLICE_SECONDS, MOST_QUERIES = 0.1, 5


def play_rounds(
    subjects: Sequence[Subject], queries: Sequence[Observation], rounds: int, report: Report = silent
) -> Iterator[tuple[Visit, ...]]:
    """The visits of each round, in the order of the subjects; one thread, and no garbage collection within a round.

    All subjects are asked the same queries in a round, those that are slow only the first ones of them.

    Args:
        subjects: to be timed.
        queries: of the test drive.
        rounds: how many.
        report: is told of each visit.
    """
    with one_thread():
        counts = [_warm_up(subject, queries[0]) for subject in subjects]
    random = np.random.default_rng(0)
    for number in range(rounds):
        asked = [queries[i] for i in round_queries(number, len(queries))]
        visits: dict[int, Visit] = {}
        with one_thread(), no_collection():
            for turn in random.permutation(len(subjects)):
                visits[turn] = visit(subjects[turn], asked[: counts[turn]])
                report("rounds", number * len(subjects) + len(visits), rounds * len(subjects))
        yield tuple(visits[turn] for turn in range(len(subjects)))


def _warm_up(subject: Subject, query: Observation) -> int:
    """Let everything be compiled and loaded, then see how many queries fit in a visit."""
    visit(subject, [query])
    return queries_a_visit(lap(subject.localizer.respond, query)[0].wall)


def queries_a_visit(seconds: float) -> int:
    """How many queries of so many seconds each a visit gets."""
    return int(min(max(SLICE_SECONDS // max(seconds, 1e-9), 1), MOST_QUERIES))


def round_queries(number: int, frames: int) -> list[int]:
    """The frames that a round asks for: no two alike where there are enough, from all along the drive."""
    golden = (sqrt(5) - 1) / 2
    first = number * MOST_QUERIES
    return [int((first + turn) * golden % 1 * frames) for turn in range(MOST_QUERIES)]
