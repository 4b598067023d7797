"""What every timing shares: one thread, and a few frames of the embedded street, drawn beforehand."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import cv2
import pytest
from threadpoolctl import threadpool_limits

from vprbench.agents import build_encoder
from vprbench.catalogue import load_route
from vprbench.observation import Drive
from vprbench.protocols import Encoder
from vprbench.provenance import versions
from vprbench.route import Route, Traverse
from vprbench.types import Frame, Observation

FRAMES = 10

# What each timing found besides its time, by the timing's name.
FOUND = pytest.StashKey[dict[str, dict[str, Any]]]()


def pytest_benchmark_update_machine_info(machine_info: dict[str, Any]) -> None:
    """Keep the versions beside the machine: both decide a timing."""
    machine_info["versions"] = versions()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--ann-places", default="1000,10000", help="sizes of the maps that test_ann.py grows, rising")
    parser.addoption("--sweep", help="the sweep that test_sweeps.py holds against its cells one by one")


@pytest.fixture(autouse=True)
def found(request: pytest.FixtureRequest) -> Iterator[None]:
    """Keep what a timing found besides its time: ratios, recalls, sizes."""
    yield
    if benchmark := request.node.funcargs.get("benchmark"):
        request.config.stash.setdefault(FOUND, {})[request.node.name] = dict(benchmark.extra_info)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Print it after the times, which is all that pytest-benchmark prints."""
    if config.getoption("benchmark_disable"):
        return
    for name, extra in config.stash.get(FOUND, {}).items():
        measured = {key: value for key, value in extra.items() if isinstance(value, float)}
        if measured:
            terminalreporter.section(name, sep="-")
        for key, value in measured.items():
            terminalreporter.line(f"{key:32} {value:.4g}")


class Drawn:
    """Frames kept in memory, so that no timing contains the drawing."""

    def __init__(self, frames: Sequence[Frame]) -> None:
        self.frames = frames

    def __getitem__(self, index: int) -> Frame:
        return self.frames[index].copy()


@pytest.fixture(scope="session", autouse=True)
def one_thread() -> Iterator[None]:
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    with threadpool_limits(1):
        yield
    cv2.setNumThreads(threads)


def sample(traverse: Traverse) -> Traverse:
    """A few frames of a drive, evenly spread over all of it."""
    chosen = slice(0, len(traverse), -(-len(traverse) // FRAMES))
    return replace(
        traverse,
        frames=Drawn([observation["frame"] for observation in Drive(traverse)[chosen]]),
        positions=traverse.positions[chosen],
        headings=traverse.headings[chosen],
        times=traverse.times[chosen],
        indices=traverse.indices[chosen],
        geodetic=None if traverse.geodetic is None else traverse.geodetic[chosen],
    )


@pytest.fixture(scope="session")
def street() -> Route:
    """The wide street, a few frames of each drive."""
    route = load_route("Street-Wide")
    training = [sample(traverse) for traverse in route.training]
    return replace(route, learn=sample(route.learn), test=sample(route.test), training=training)


@pytest.fixture(scope="session")
def training(street: Route) -> list[list[Observation]]:
    return [list(Drive(traverse)) for traverse in street.training]


@pytest.fixture(scope="session")
def fitted_encoder(training: list[list[Observation]]) -> Callable[[str], Encoder]:
    """Encoders by name, each fitted once for all timings."""
    frames = [observation["frame"] for drive in training for observation in drive]

    @cache
    def fitted(name: str) -> Encoder:
        encoder = build_encoder(name)
        encoder.fit(frames)
        return encoder

    return fitted
