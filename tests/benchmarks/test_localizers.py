"""How long each registered localizer takes to describe a frame, to answer with 10, 100 and 1000 places, and to add one.

Group "locate one query" times those that find the best place without the response of every place, against all responses
at the same turn: `extra_info["per_respond"]` is the ratio of the CPU times of both, over several queries; "matched",
of CoHOG, the share of regions that were matched.

Group "answer one query on every core" times those that have the option `threads`: `extra_info["quicker"]` is the time
of one thread by the clock over that of as many as there are cores, at the same turn.

One that looks through an encoder is timed with each registered encoder; but with `ENCODER` alone where it has no
`compare`, since its time does not tell encoders apart. Max-Pi besides keeps log-polar maps as bytes.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from functools import cache
from itertools import cycle, islice
from statistics import mean, median
from time import perf_counter, process_time
from typing import Any, TypeAlias

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from vprbench.agents import label
from vprbench.observation import Drive
from vprbench.options import parameters
from vprbench.plugins import find, plugins
from vprbench.protocols import DescriptorLocalizer, Encoder, Localizer, Locating, Storing
from vprbench.route import Route
from vprbench.types import Observation, hypothesis
from vprbench_localizers.cohog import CoHOG

Agent: TypeAlias = dict[str, str]

# As a vigilance and as a step in metres, 1 makes every frame a place that is far away and matches nothing.
SAMPLING = 1.0

ENCODER = "hsd-15-30"


def agents() -> Iterator[Agent]:
    """Every localizer, with every encoder if it takes one; and signatures of one byte a value."""
    for name, plugin in plugins("localizer").items():
        if "encoder" in parameters(factory := plugin.load()):
            encoders = plugins("encoder") if hasattr(factory, "compare") else [ENCODER]
            yield from ({"localizer": name, "encoder": encoder} for encoder in encoders)
        else:
            yield {"localizer": name}
    yield {"localizer": "max-pi", "encoder": "log-polar", "storage": "uint8"}


AGENTS = list(agents())
THREADED = [agent for agent in AGENTS if "threads" in parameters(find("localizer", agent["localizer"]).load())]


class Memory:
    """A trained localizer, holding as many places as are asked for."""

    def __init__(self, localizer: Localizer, observations: list[Observation]) -> None:
        self.localizer = localizer
        self.observations = observations
        self.places = 0
        self.described: dict[bytes, object] = {}
        localizer.clear(SAMPLING)

    def hold(self, places: int) -> None:
        if places < self.places:
            self.places = 0
            self.localizer.clear(SAMPLING)
        while self.places < places:
            self.places += self._grow(self.observations[self.places % len(self.observations)])

    def _grow(self, observation: Observation) -> bool:
        """Make one more place, without asking the others first if that can be had."""
        if isinstance(self.localizer, Storing):
            frame = observation["frame"].tobytes()
            if frame not in self.described:
                self.described[frame] = self.localizer.describe(observation)
            return self.localizer.store(self.described[frame]) == self.places
        elsewhere = Observation(**{**observation, "gps": np.array([1e3 * self.places, 0.0])})
        return self.localizer.learn(elsewhere) is not None


@pytest.fixture(scope="module")
def memory_of(
    street: Route, training: list[list[Observation]], fitted_encoder: Callable[[str], Encoder]
) -> Callable[..., Memory]:
    """Memories by localizer, encoder and options, each trained once for all timings."""

    @cache
    def trained(localizer: str, encoder: str | None = None, **options: str) -> Memory:
        through = {"encoder": fitted_encoder(encoder)} if encoder else {}
        made: Any = find("localizer", localizer).load()(**through, **options)
        made.fit(training)
        return Memory(made, list(Drive(street.learn)))

    return trained


@pytest.fixture
def queries(street: Route) -> Iterator[Observation]:
    return cycle(Drive(street.test, gps=False)[:])


@pytest.fixture
def memory(memory_of: Callable[..., Memory], agent: Agent) -> Memory:
    return memory_of(**agent)


@pytest.mark.benchmark(group="describe one frame")
@pytest.mark.parametrize("agent", AGENTS, ids=label)
def test_describe(benchmark: BenchmarkFixture, memory: Memory, queries: Iterator[Observation], agent: Agent) -> None:
    localizer = memory.localizer
    if not isinstance(localizer, DescriptorLocalizer):
        pytest.skip("it does not describe frames one by one")
    localizer.describe(next(queries))
    benchmark.extra_info |= agent
    benchmark(lambda: localizer.describe(next(queries)))


@pytest.mark.benchmark(group="answer one query")
@pytest.mark.parametrize("places", [10, 100, 1000])
@pytest.mark.parametrize("agent", AGENTS, ids=label)
def test_respond(
    benchmark: BenchmarkFixture, memory: Memory, queries: Iterator[Observation], agent: Agent, places: int
) -> None:
    memory.hold(places)
    assert memory.localizer.respond(next(queries)).shape == (places,)
    benchmark.extra_info |= {**agent, "places": places}
    benchmark(lambda: memory.localizer.respond(next(queries)))


@pytest.mark.benchmark(group="answer one query on every core")
@pytest.mark.parametrize("places", [100, 1000])
@pytest.mark.parametrize("agent", THREADED, ids=label)
def test_respond_on_every_core(
    benchmark: BenchmarkFixture, memory: Memory, queries: Iterator[Observation], agent: Agent, places: int
) -> None:
    memory.hold(places)
    localizer: Any = memory.localizer
    cores = os.cpu_count() or 1

    def seconds(threads: int, query: Observation) -> float:
        localizer.threads = threads
        started = perf_counter()
        localizer.respond(query)
        return perf_counter() - started

    try:
        benchmark(lambda: seconds(cores, next(queries)))
        turns = [(seconds(1, query), seconds(cores, query)) for query in islice(queries, 10 if benchmark.stats else 1)]
    finally:
        localizer.threads = 1
    quicker = median(one / all_ for one, all_ in turns)
    benchmark.extra_info |= {**agent, "places": places, "cores": cores, "quicker": quicker}


@pytest.mark.benchmark(group="locate one query")
@pytest.mark.parametrize("places", [10, 100, 1000])
@pytest.mark.parametrize("agent", AGENTS, ids=label)
def test_locate(
    benchmark: BenchmarkFixture, memory: Memory, queries: Iterator[Observation], agent: Agent, places: int
) -> None:
    localizer = memory.localizer
    if not isinstance(localizer, Locating):
        pytest.skip("it has no locate")
    memory.hold(places)
    asked = next(queries)
    assert localizer.locate(asked) == hypothesis(localizer.respond(asked))
    benchmark.extra_info |= {**agent, "places": places}
    benchmark(lambda: localizer.locate(next(queries)))
    if benchmark.stats:
        seen = [next(queries) for _ in range(3)]
        benchmark.extra_info |= {"per_respond": cpu(localizer.locate, seen) / cpu(localizer.respond, seen)}
        if isinstance(localizer, CoHOG):
            benchmark.extra_info |= {"matched": mean(localizer.search(localizer.describe(q)).matched for q in seen)}


def cpu(answer: Callable[[Observation], object], queries: list[Observation]) -> float:
    """Seconds of CPU time that answers take."""
    started = process_time()
    for query in queries:
        answer(query)
    return process_time() - started


@pytest.mark.benchmark(group="add one place to 1000")
@pytest.mark.parametrize("agent", AGENTS, ids=label)
def test_store(benchmark: BenchmarkFixture, memory: Memory, queries: Iterator[Observation], agent: Agent) -> None:
    localizer = memory.localizer
    if not isinstance(localizer, Storing):
        pytest.skip("it cannot be given places outright")
    memory.hold(1000)
    described = cycle([localizer.describe(query) for query in islice(queries, 20)])
    benchmark.extra_info |= agent
    benchmark.pedantic(lambda: localizer.store(next(described)), rounds=500, warmup_rounds=5)  # type: ignore[no-untyped-call]
    memory.places = len(localizer.respond(next(queries)))
