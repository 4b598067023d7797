"""How often the approximate index finds the places that Max-Pi itself finds, and what it costs, as the map grows.

A place is put together of two frames of a route: of its landmarks each is that of one frame or the other, and keeps
about 3 in 5 values of its signature, to which 2 in 5 of another landmark's are added; then the place is turned to one
of four directions. The first places are the learn drive's own. Queries are the frames of the test drive, whose road is
in the map, and the same turned by a quarter, as if from roads that the learn drive never took.

    pytest tests/benchmarks/test_ann.py --benchmark-only --ann-places 1000,10000,100000,1000000

keeps, as `extra_info`, recall@1 and recall@5 against Max-Pi for both kinds of queries, the milliseconds of CPU time
a query of both, those of storing a place, the bytes in use a place, and the most memory that the process took. Max-Pi's
places are answered and forgotten, so many at a time: its time is the sum.
"""

from __future__ import annotations

from itertools import cycle
from math import pi
from pathlib import Path
from resource import RUSAGE_SELF, getrusage
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
POINTS = 25

# The best places of a query that are compared.
BEST = 5

# Places that Max-Pi holds at a time: half a gigabyte.
PART = 100_000

# Of a landmark in faiss: its vector and the number of its place.
INDEXED = 64 + 8


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
    """Max-Pi and its index over the same growing map, and the best responses of Max-Pi to each query, falling."""

    def __init__(self, encoder: Encoder, route: Route) -> None:
        drives = [Drive(drive) for drive in route.training]
        self.exact, self.index = MaxPi(encoder), MaxPiAnn(encoder)
        self.exact.fit(drives)
        self.index.fit(drives)
        described = [self.exact.describe(seen) for drive in (Drive(route.learn), *drives) for seen in drive]
        self.blocks = Blocks(described)
        seen = [self.exact.describe(observation) for observation in Drive(route.test, gps=False)]
        self.queries = seen + [turned(view) for view in seen]
        self.best = np.zeros((len(self.queries), BEST), np.float32)
        self.places, self.pending = 0, 0
        self.index_seconds, self.exact_seconds, self.answer_seconds = 0.0, 0.0, 0.0
        self.grow(described[: len(route.learn)])

    def grow_to(self, places: int) -> None:
        while self.places < places:
            self.grow(self.blocks.block(self.places)[: places - self.places])
        self.answer()

    def grow(self, views: list[View]) -> None:
        started = process_time()
        for view in views:
            self.index.store(view)
        half = process_time()
        for view in views:
            self.exact.store(view)
        self.index_seconds += half - started
        self.exact_seconds += process_time() - half
        self.places, self.pending = self.places + len(views), self.pending + len(views)
        if self.pending >= PART:
            self.answer()

    def answer(self) -> None:
        """Let Max-Pi answer every query by the places that it holds, and forget them."""
        for query, best in zip(self.queries, self.best, strict=True):
            started = process_time()
            responses = self.exact.answer(query)
            self.answer_seconds += process_time() - started
            best[:] = highest(np.concatenate([best, responses]))
        self.exact.clear(self.exact.vigilance)
        self.pending = 0


def turned(view: View) -> View:
    return View(view.signatures, wrap(view.azimuths.astype(np.float64) + pi / 2).astype(np.float32))


def highest(responses: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.sort(np.partition(responses, -BEST)[-BEST:])[::-1]


def recall(found: NDArray[np.float32], best: NDArray[np.float32], at: int) -> float:
    """The share of each query's `at` best responses that were found; of equal ones any will do."""
    return float(np.mean(found[:, :at] >= best[:, at - 1 : at]))


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
    found, half = np.stack([highest(answer) for answer in answers]), len(race.queries) // 2
    # A place reached responds as in Max-Pi, so that none can respond more strongly.
    assert (found <= race.best).all()
    queries = cycle(race.queries)
    benchmark.extra_info |= {
        "places": race.places,
        "queries": half,
        "recall_at_1": recall(found[:half], race.best[:half], 1),
        "recall_at_5": recall(found[:half], race.best[:half], BEST),
        "elsewhere_recall_at_1": recall(found[half:], race.best[half:], 1),
        "elsewhere_recall_at_5": recall(found[half:], race.best[half:], BEST),
        "responding": float(np.mean([np.count_nonzero(answer) for answer in answers])),
        "index_ms": 1e3 * seconds / len(race.queries),
        "exact_ms": 1e3 * race.answer_seconds / len(race.queries),
        "index_store_ms": 1e3 * race.index_seconds / race.places,
        "exact_store_ms": 1e3 * race.exact_seconds / race.places,
        "index_bytes_per_place": used_bytes(race.index) / race.places,
        "peak_gigabytes": getrusage(RUSAGE_SELF).ru_maxrss / 1e6,
    }
    benchmark(lambda: race.index.answer(next(queries)))


def used_bytes(index: MaxPiAnn) -> int:
    units = index._views.units
    return sum(kept.nbytes for kept in units) + INDEXED * len(units.azimuths)
