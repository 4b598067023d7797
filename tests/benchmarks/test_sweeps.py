"""How much less a sweep takes than its cells one by one: each by a `vprbench run` of its own, and each played.

    pytest tests/benchmarks/test_sweeps.py --benchmark-only --sweep streets

keeps, as `extra_info`, the CPU seconds (user and system, of all processes) of the whole sweep with one worker, those
of all runs, and those of playing each cell frame by frame through the environment, learning anew for every vigilance
tried, as is done for an agent that cannot compare; those by the clock of the sweep with a worker a core, and of all
runs; and the ratios. Without `--sweep` it is a small one
of four cells. Both begin with an empty store of fitted encoders; the small one goes before, uncounted, and compiles.
Python must be allowed to keep its bytecode (PYTHONDONTWRITEBYTECODE unset), or every process compiles all that it
imports anew.
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


def played(cell: Cell, config: Config, routes: Path | None) -> float:
    """CPU seconds of playing one cell through the environment, in this process, where all is imported."""
    began = process_time()
    route = load_route(cell.route, routes=routes)
    localizer = fitted_agent(config, cell.seed, route.training)
    calibrate(localizer, route, cell.sampling_distance)
    recording = play(RouteEnv(route, cell.sampling_distance), localizer)
    trace = judge(route, recording, cell.sampling_distance)
    assert evaluate(trace) | intervals(trace)
    return process_time() - began


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
    alone = [taken(*words, "--cache", str(tmp_path / "alone")) for words in commands]
    cpu, clock = (sum(seconds) for seconds in zip(*alone, strict=True))
    by_playing = sum(played(cell, sweep.agents[cell.agent], routes) for cell in cells)
    benchmark.extra_info |= {
        "cells": len(cells),
        "sweep_cpu_s": one.cpu,
        "runs_cpu_s": cpu,
        "runs_over_sweep_cpu": cpu / one.cpu,
        "played_cpu_s": by_playing,
        "played_over_sweep_cpu": by_playing / one.cpu,
        "sweep_clock_s": all_cores.clock,
        "runs_clock_s": clock,
        "runs_over_sweep_clock": clock / all_cores.clock,
    }
    assert cpu > one.cpu
