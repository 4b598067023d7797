"""How much less a sweep takes than its cells one by one, each by a `vprbench run` of its own.

    pytest tests/benchmarks/test_sweeps.py --benchmark-only --sweep streets

keeps, as `extra_info`, the CPU seconds (user and system, of all processes) of the whole sweep with one worker, those
of all runs, and their ratio; the benchmark's own time is the sweep's by the clock. Without `--sweep` it is a small one
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

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

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


def seconds(*words: str) -> float:
    """CPU seconds of one call of the command line and of all processes that it starts, one thread each."""
    single = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "NUMBA")}
    before = getrusage(RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-m", "vprbench", *words], env=os.environ | single, check=True, capture_output=True)
    after = getrusage(RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


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
    seconds("sweep", str(small), "--jobs", "1", "--out", str(tmp_path / "warm"), "--cache", str(tmp_path / "warm"))

    def whole() -> float:
        return seconds("sweep", name, "--jobs", "1", "--out", str(tmp_path / "out"), "--cache", str(tmp_path / "swept"))

    swept = benchmark.pedantic(whole, rounds=1)  # type: ignore[no-untyped-call]
    runs = [words_for(cell, sweep.agents[cell.agent], routes) for cell in sweep.cells()]
    alone = sum(seconds(*words, "--cache", str(tmp_path / "alone")) for words in runs)
    benchmark.extra_info |= {"cells": len(runs), "sweep_s": swept, "alone_s": alone, "ratio": alone / swept}
    assert alone > swept
