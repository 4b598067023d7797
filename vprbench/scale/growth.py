"""One agent as its map grows: what a query, a place and learning cost at each size, until a limit stops it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field

from vprbench.errors import PluginError
from vprbench.frequency.stopwatch import Lap, Visit, lap, no_collection, visit
from vprbench.frequency.subjects import STEP, VIGILANCE, Agent, Subject, make_place
from vprbench.protocols import Storing
from vprbench.reporting import Report, silent
from vprbench.scale.city import City, CityPlace
from vprbench.scale.held import held_bytes
from vprbench.threads import one_thread
from vprbench.types import Observation

__all__ = ["Limits", "Size", "grow"]

# So many of a size's places are learned as on a drive: compared with all others first.
LEARNED = 3


@dataclass(frozen=True)
class Limits:
    """What ends a curve before it gets there.

    Attributes:
        gigabytes: that the places would hold.
        seconds: that a query would take.
    """

    gigabytes: float
    seconds: float


@dataclass(frozen=True)
class Size:
    """An agent with so many places, or why there is none.

    Attributes:
        places: how many.
        visits: queries, each timed by itself.
        held: bytes of all places.
        added: seconds to add a place, its landmarks at hand.
        learned: the same where `learn` decides whether it is due.
        stopped: what ended the curve before this size; empty if nothing did.
    """

    places: int
    visits: Sequence[Visit] = ()
    held: int = 0
    added: float = float("nan")
    learned: Sequence[Lap] = field(default=())
    stopped: str = ""


def grow(
    agent: Agent,
    city: City,
    queries: Sequence[Observation],
    sizes: Sequence[int],
    limits: Limits,
    report: Report = silent,
) -> Iterator[Size]:
    """The agent at each size (rising), on one thread; the last one says so if a limit stopped it.

    Raises:
        PluginError: the agent makes no place of one that the city shows.
    """
    sampling = VIGILANCE if agent.localizer.recruiting == "vigilance" else STEP
    agent.localizer.clear(sampling)
    # Uncounted, since it may compile.
    _fill(agent, city, 0, 1, 1, silent)
    agent.localizer.clear(sampling)
    empty = _held(agent)
    reached = Size(0)
    for places in sizes:
        if stopped := _stops(reached, places, limits):
            yield Size(places, stopped=stopped)
            return
        with one_thread(), no_collection():
            added = _fill(agent, city, reached.places, places - LEARNED, places, report)
            learned = [_learn(agent, city[index]) for index in range(max(reached.places, places - LEARNED), places)]
            subject = Subject(agent.name, places, "", agent.localizer, agent.rehearsal)
            visits = [visit(subject, [city.query(query, turn)]) for turn, query in enumerate(queries)]
        reached = Size(places, visits, _held(agent) - empty, added, learned)
        yield reached


def _stops(reached: Size, places: int, limits: Limits) -> str:
    """Why the next size is not tried, by what the last one took; empty if it is."""
    if not reached.places:
        return ""
    times = places / reached.places
    gigabytes, seconds = times * reached.held / 1e9, times * max(done.query.wall for done in reached.visits)
    if gigabytes > limits.gigabytes:
        return f"would hold {gigabytes:.3g} GB of places, above {limits.gigabytes:g} GB"
    if seconds > limits.seconds:
        return f"would take {seconds:.3g} s a query, above {limits.seconds:g} s"
    return ""


def _held(agent: Agent) -> int:
    encoder = () if agent.rehearsal is None else (agent.rehearsal, agent.rehearsal.encoder)
    return held_bytes(agent.localizer, without=encoder)


def _fill(agent: Agent, city: City, first: int, end: int, total: int, report: Report) -> float:
    """Add these places; seconds each took on average, or not a number if there are none."""
    seconds = 0.0
    for index in range(first, end):
        place = city[index]
        with _seeing(agent, place, blank=not isinstance(agent.localizer, Storing)):
            laps, made = lap(lambda seen: make_place(agent.localizer, seen), place.observation)
        _must_be_made(agent, made, index)
        seconds += laps.wall
        if index % 100 == 0:
            report("places", index, total)
    return seconds / (end - first) if end > first else float("nan")


def _learn(agent: Agent, place: CityPlace) -> Lap:
    """Let the agent learn a place as on a drive."""
    with _seeing(agent, place):
        laps, made = lap(agent.localizer.learn, place.observation)
    _must_be_made(agent, made is not None, int(place.observation["gps"][1]))
    return laps


def _seeing(agent: Agent, place: CityPlace, *, blank: bool = False) -> AbstractContextManager[None]:
    if agent.rehearsal is None or place.landmarks is None:
        return nullcontext()
    return agent.rehearsal.recalling(place.landmarks, blank=blank)


def _must_be_made(agent: Agent, made: bool, index: int) -> None:
    if not made:
        raise PluginError(f"{agent.name}: makes no place of what it is shown after {index} places, though it is new")
