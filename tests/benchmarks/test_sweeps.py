"""How much less a sweep takes than its cells one by one: each played, and each by a `vprbench run` of its own.

    pytest tests/benchmarks/test_sweeps.py --benchmark-only --sweep streets

keeps, as `extra_info`, CPU seconds (user and system, of all processes) and seconds by the clock of

- the whole sweep, with one worker for CPU time and with a worker a core for the clock;
- all cells played, one after the other, frame by frame through the environment: each fits its agent, and learns anew
  for every vigilance tried, as is done for an agent that cannot compare;
- all cells by `vprbench run`, which keeps fitted encoders for the next, and finds its vigilance from a response matrix;

and the ratios to the sweep. Without `--sweep` it is a small one of four cells. Sweeps and runs begin with an empty
store of fitted encoders; the small one goes before, uncounted, and compiles. Python must be allowed to keep its
bytecode (PYTHONDONTWRITEBYTECODE unset), or every process compiles all that it imports anew.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage
from time import perf_counter, process_time
from typing import NamedTuple

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from vprbench.agents import Config
from vprbench.bootstrap import intervals
from vprbench.catalogue import load_route
from vprbench.env import RouteEnv
from vprbench.episode import calibrate, judge, play
from vprbench.fitted import fitted_agent
from vprbench.metrics import evaluate
from vprbench.sweep import Cell, load_sweep
from vprbench.threads import one_thread

SMALL = """
routes = ["Tiny"]
sampling_distances = [2, 5]
routes_file = "routes.toml"

[agents]
LPMP = { localizer = "max-pi", encoder = "log-polar" }
CoHOG = { localizer = "cohog" }
"""

ROUTES = """
[routes.Tiny]
reader = "street"
environment = "narrow"
length = 20
"""


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A sweep of four cells, on a street of its own."""
    (tmp_path / "routes.toml").write_text(ROUTES)
    (tmp_path / "small.toml").write_text(SMALL)
    return tmp_path / "small.toml"


class Taken(NamedTuple):
    """What a command took, seconds: of all processors together, and by the clock."""

    cpu: float
    clock: float


def taken(*words: str) -> Taken:
    """What one call of the command line took, with all processes that it starts, one thread each."""
    single = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "NUMBA")}
    before, began = getrusage(RUSAGE_CHILDREN), perf_counter()
    subprocess.run([sys.executable, "-m", "vprbench", *words], env=os.environ | single, check=True, capture_output=True)
    after, clock = getrusage(RUSAGE_CHILDREN), perf_counter() - began
    return Taken(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, clock)


def played(cell: Cell, config: Config, routes: Path | None) -> Taken:
    """What playing one cell through the environment takes, on one thread of this process, where all is imported."""
    before, began = process_time(), perf_counter()
    route = load_route(cell.route, routes=routes)
    with one_thread():
        localizer = fitted_agent(config, cell.seed, route.training)
        calibrate(localizer, route, cell.sampling_distance)
        recording = play(RouteEnv(route, cell.sampling_distance), localizer)
        trace = judge(route, recording, cell.sampling_distance)
        assert evaluate(trace) | intervals(trace)
    return Taken(process_time() - before, perf_counter() - began)


def total(parts: list[Taken]) -> Taken:
    """What all of them took, one after the other."""
    cpu, clock = (sum(seconds) for seconds in zip(*parts, strict=True))
    return Taken(cpu, clock)


def inline(value: object) -> str:
    """A value in a TOML table of one line."""
    if not isinstance(value, dict):
        return json.dumps(value)
    return "{ " + ", ".join(f"{key} = {inline(one)}" for key, one in value.items()) + " }"


def words_for(cell: Cell, config: object, routes: Path | None) -> list[str]:
    """The `vprbench run` that measures one cell."""
    agent = config if isinstance(config, str) else inline(config)[2:-2]
    words = ["run", cell.route, agent, "--distance", f"{cell.sampling_distance:g}", "--seed", f"{cell.seed}"]
    return words if routes is None else [*words, "--routes", str(routes)]


@pytest.mark.benchmark(group="a sweep and its cells one by one")
def test_a_sweep_takes_less_than_its_cells_one_by_one(
    benchmark: BenchmarkFixture, request: pytest.FixtureRequest, small: Path, tmp_path: Path
) -> None:
    name = request.config.getoption("sweep") or str(small)
    question, sweep = load_sweep(name)
    routes = question.parent / sweep.routes_file if sweep.routes_file else None
    cells = list(sweep.cells())

    def swept(jobs: int, store: str) -> Taken:
        folders = "--out", str(tmp_path / f"out-{store}"), "--cache", str(tmp_path / store)
        return taken("sweep", name, "--jobs", str(jobs), *folders)

    taken("sweep", str(small), "--jobs", "1", "--out", str(tmp_path / "warm"), "--cache", str(tmp_path / "warm"))
    one = benchmark.pedantic(swept, args=(1, "one"), rounds=1)  # type: ignore[no-untyped-call]
    all_cores = swept(os.cpu_count() or 1, "all")
    commands = [words_for(cell, sweep.agents[cell.agent], routes) for cell in cells]
    by_playing = total([played(cell, sweep.agents[cell.agent], routes) for cell in cells])
    by_runs = total([taken(*words, "--cache", str(tmp_path / "alone")) for words in commands])
    benchmark.extra_info |= {
        "cells": len(cells),
        "sweep_cpu_s": one.cpu,
        "sweep_clock_s": all_cores.clock,
        "played_cpu_s": by_playing.cpu,
        "played_clock_s": by_playing.clock,
        "played_over_sweep_cpu": by_playing.cpu / one.cpu,
        "played_over_sweep_clock": by_playing.clock / all_cores.clock,
        "runs_cpu_s": by_runs.cpu,
        "runs_clock_s": by_runs.clock,
        "runs_over_sweep_cpu": by_runs.cpu / one.cpu,
        "runs_over_sweep_clock": by_runs.clock / all_cores.clock,
    }
    assert by_runs.cpu > one.cpu
