"""How often the approximate index finds the place that Max-Pi itself finds, and what it costs, as the map grows.

A place is put together of two frames of a route: of its landmarks each is that of one frame or the other, and keeps
about 3 in 5 values of its signature, to which 2 in 5 of another landmark's are added; then the place is turned to one
of four directions. The first places are the learn drive's own, and the queries frames of the test drive.

    pytest tests/benchmarks/test_ann.py --benchmark-only --ann-places 1000,10000,100000

keeps, as `extra_info`, recall@1 against Max-Pi, the milliseconds of CPU time a query of both, those of learning a
place, and how many places respond. By the rates seen, a million places need 10 GB, 12 minutes to learn, and 2 for
Max-Pi's answers.
"""

from __future__ import annotations

from itertools import cycle
from math import pi
from pathlib import Path
from time import process_time

import numpy as np
import pytest
from numpy.typing import NDArray
from pytest_benchmark.fixture import BenchmarkFixture

from vprbench.agents import build_encoder
from vprbench.catalogue import load_route
from vprbench.geodesy import wrap
from vprbench.observation import Drive
from vprbench.protocols import Encoder
from vprbench.route import Route
from vprbench_localizers.max_pi import MaxPi
from vprbench_localizers.max_pi_ann import MaxPiAnn
from vprbench_localizers.unit_activity import View

BLOCK = 1000
QUERIES = 20
POINTS = 25


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "places" in metafunc.fixturenames:
        metafunc.parametrize("places", [int(n) for n in metafunc.config.getoption("ann_places").split(",")])


@pytest.fixture(scope="module")
def route(request: pytest.FixtureRequest, street: Route) -> Route:
    """KITTI-K0-2, or a few frames of a drawn street where that is absent or nothing is timed."""
    try:
        root: Path = request.getfixturevalue("kitti_root")
    except pytest.skip.Exception:
        return street
    return street if request.config.getoption("benchmark_disable") else load_route("KITTI-K0-2", root)


class Blocks:
    """Synthetic places, a block at a time; the same block is always the same."""

    def __init__(self, views: list[View]) -> None:
        whole = [view for view in views if len(view.azimuths) == POINTS]
        self.signatures = np.stack([view.signatures for view in whole])
        self.azimuths = np.stack([view.azimuths for view in whole])
        self.pool = self.signatures.reshape(-1, self.signatures.shape[2])

    def block(self, number: int) -> list[View]:
        random = np.random.default_rng(number)
        one, other = random.integers(len(self.signatures), size=(2, BLOCK))
        first = random.random((BLOCK, POINTS)) < 0.5
        signatures = np.where(first[..., None], self.signatures[one], self.signatures[other])
        added = self.pool[random.integers(len(self.pool), size=(BLOCK, POINTS))]
        kept, taken = (random.random(signatures.shape, np.float32) < share for share in (0.6, 0.4))
        azimuths = np.where(first, self._relative(one), self._relative(other)) + pi / 2 * random.integers(
            4, size=(BLOCK, 1)
        )
        mixed = np.maximum(signatures * kept, added * taken)
        return [View(*pair) for pair in zip(mixed, wrap(azimuths).astype(np.float32), strict=True)]

    def _relative(self, frames: NDArray[np.int64]) -> NDArray[np.float64]:
        """The azimuths of some frames, about 0."""
        azimuths = self.azimuths[frames].astype(np.float64)
        return wrap(azimuths - azimuths[:, :1])


class Race:
    """Max-Pi and its index over the same growing map, and the best response of either to each query."""

    def __init__(self, encoder: Encoder, route: Route) -> None:
        drives = [Drive(drive) for drive in route.training]
        self.exact, self.index = MaxPi(encoder), MaxPiAnn(encoder)
        self.exact.fit(drives)
        self.index.fit(drives)
        described = [self.exact.describe(seen) for drive in (Drive(route.learn), *drives) for seen in drive]
        self.learned, self.blocks = described[: len(route.learn)], Blocks(described)
        seen = Drive(route.test, gps=False)
        self.queries = [self.exact.describe(seen[k]) for k in range(0, len(seen), -(-len(seen) // QUERIES))]
        self.best = np.zeros(len(self.queries), np.float32)
        self.places, self.learn_seconds, self.exact_seconds = 0, 0.0, 0.0
        self.grow(self.learned)

    def grow_to(self, places: int) -> None:
        while self.places < places:
            self.grow(self.blocks.block(self.places)[: places - self.places])

    def grow(self, views: list[View]) -> None:
        started = process_time()
        for view in views:
            self.index.store(view)
        learned = process_time()
        responses = self.exact.compare(self.queries, views)
        self.exact_seconds += process_time() - learned
        self.learn_seconds += learned - started
        self.best = np.maximum(self.best, responses.max(axis=1))
        self.places += len(views)


@pytest.fixture(scope="module")
def race(request: pytest.FixtureRequest, route: Route) -> Race:
    """Looking through HSD-15/30, fitted to the route."""
    hurried = {"steps": 1, "epochs": 1} if request.config.getoption("benchmark_disable") else {}
    encoder = build_encoder({"name": "hsd-15-30", **hurried})
    encoder.fit([seen["frame"] for drive in route.training for seen in Drive(drive)])
    return Race(encoder, route)


@pytest.mark.benchmark(group="answer one query of a large map")
def test_recall(benchmark: BenchmarkFixture, race: Race, places: int) -> None:
    race.grow_to(places)
    race.index.answer(race.queries[0])
    started = process_time()
    answers = [race.index.answer(query) for query in race.queries]
    seconds = process_time() - started
    assert all(answer.shape == (race.places,) for answer in answers)
    found = [answer.max() == best for answer, best in zip(answers, race.best, strict=True)]
    queries = cycle(race.queries)
    benchmark.extra_info |= {
        "places": race.places,
        "recall_at_1": float(np.mean(found)),
        "responding": float(np.mean([np.count_nonzero(answer) for answer in answers])),
        "learn_ms": 1e3 * race.learn_seconds / race.places,
        "index_ms": 1e3 * seconds / len(race.queries),
        "exact_ms": 1e3 * race.exact_seconds / len(race.queries),
    }
    benchmark(lambda: race.index.answer(next(queries)))
