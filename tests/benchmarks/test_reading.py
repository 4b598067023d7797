"""What reading ahead saves of a job of `k0-2` by the clock, where a core is free.

    pytest tests/benchmarks/test_reading.py --benchmark-only

keeps, as `extra_info["of_the_time"]`, the time with frames read ahead over that without, the median of turns of both.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from time import perf_counter

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from vprbench.readers import read_ahead
from vprbench.readers.read_ahead import AHEAD
from vprbench.runner import run
from vprbench.sweep import jobs, load_sweep
from vprbench.threads import one_thread

TURNS = 8


@pytest.mark.benchmark(group="a job whose frames are read ahead")
@pytest.mark.parametrize("agent", ["LPMP", "CoHOG"])
def test_reading_ahead(
    benchmark: BenchmarkFixture, kitti_root: Path, monkeypatch: pytest.MonkeyPatch, agent: str
) -> None:
    _, sweep = load_sweep("k0-2")
    job = next(job for job in jobs(sweep, list(sweep.cells())) if job.agent == agent)

    def seconds(ahead: int) -> float:
        monkeypatch.setattr(read_ahead, "AHEAD", ahead)
        started = perf_counter()
        with one_thread():
            assert all(outcome.row["status"] == "ok" for outcome in run(job, kitti_root))
        return perf_counter() - started

    benchmark.pedantic(seconds, args=(AHEAD,), rounds=1)  # type: ignore[no-untyped-call]
    if benchmark.stats:
        of_the_time = median(seconds(AHEAD) / seconds(0) for _ in range(TURNS))
        benchmark.extra_info |= {"agent": agent, "ahead": AHEAD, "of_the_time": of_the_time}
