"""How long a query takes, and its parts: by the clock on the wall, and by what the process computed meanwhile."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from time import perf_counter, process_time
from typing import NamedTuple, TypeVar

import numpy as np

from vprbench.frequency.subjects import Subject
from vprbench.protocols import DescriptorLocalizer
from vprbench.types import Observation

__all__ = ["UNTIMED", "Lap", "Visit", "lap", "no_collection", "visit"]

Argument = TypeVar("Argument")
Result = TypeVar("Result")


class Lap(NamedTuple):
    """How long a call took, seconds.

    Attributes:
        wall: by the clock on the wall.
        cpu: of all threads of this process together.
    """

    wall: float
    cpu: float


UNTIMED = Lap(float("nan"), float("nan"))


class Visit(NamedTuple):
    """What one subject took for the queries of one round, on average.

    Attributes:
        query: `respond`, from the observation to the responses.
        encode: the encoder's `encode`; where there is none, the localizer's `describe`.
        respond: the rest of a query, timed by itself; untimed where there is no encoder to leave out.
        queries: how many there were.
    """

    query: Lap
    encode: Lap
    respond: Lap
    queries: int


def lap(call: Callable[[Argument], Result], argument: Argument) -> tuple[Lap, Result]:
    """Time one call; what it returned comes second."""
    cpu, wall = process_time(), perf_counter()
    result = call(argument)
    return Lap(perf_counter() - wall, process_time() - cpu), result


def visit(subject: Subject, queries: Sequence[Observation]) -> Visit:
    """Time a subject with some queries, the last of which comes once before them, uncounted: it fills the caches."""
    subject.localizer.respond(queries[-1])
    query, encode, respond = np.mean([_laps(subject, query) for query in queries], axis=0)
    return Visit(Lap(*query), Lap(*encode), Lap(*respond), len(queries))


def _laps(subject: Subject, query: Observation) -> tuple[Lap, Lap, Lap]:
    """A whole query, then its encoding alone, then the rest alone."""
    localizer, rehearsal = subject.localizer, subject.rehearsal
    whole, _ = lap(localizer.respond, query)
    if rehearsal is not None:
        encode, landmarks = lap(rehearsal.encode, query["frame"])
        with rehearsal.recalling(landmarks):
            return whole, encode, lap(localizer.respond, query)[0]
    if isinstance(localizer, DescriptorLocalizer):
        return whole, lap(localizer.describe, query)[0], UNTIMED
    return whole, UNTIMED, UNTIMED


@contextmanager
def no_collection() -> Iterator[None]:
    """While entered, Python does not look for garbage, which would stop a call now and then."""
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
