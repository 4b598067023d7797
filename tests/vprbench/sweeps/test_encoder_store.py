"""Sweeps fit an encoder once for each configuration, seed and training set, and answer the same with or without."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

Run = Callable[..., subprocess.CompletedProcess[str]]

# The two routes differ in length alone, so they train on the same street.
ROUTES = """
[routes.Tiny]
reader = "street"
environment = "narrow"
length = 20

[routes.Longer]
reader = "street"
environment = "narrow"
length = 25
"""

QUESTION = """
routes = ["Tiny", "Longer"]
sampling_distances = [2]
seeds = [0, 1]
routes_file = "routes.toml"

[agents]
plain = { localizer = "nearest-view", encoder = "typical" }
floor = { localizer = "nearest-view", encoder = "typical", floor = 0.1 }
"""


@pytest.fixture
def log(here: Path, environment: dict[str, str]) -> Path:
    """Where the third party's encoder says whenever it learns, in any process."""
    (here / "routes.toml").write_text(ROUTES)
    (here / "tiny.toml").write_text(QUESTION)
    environment["ACME_FITS"] = str(here / "fits")
    return here / "fits"


def fits(log: Path) -> int:
    """How often it did since this was last asked."""
    text = log.read_text() if log.exists() else ""
    log.unlink(missing_ok=True)
    return len(text.split())


def test_a_sweep_fits_once_and_answers_the_same(here: Path, log: Path, vprbench: Run) -> None:
    answers = {}
    for name, cache, expected in (("off", "none", 8), ("cold", "cache", 2), ("warm", "cache", 0)):
        done = vprbench("sweep", "tiny.toml", "--out", name, "--cache", cache, "--jobs", "2")
        assert done.returncode == 0, done.stderr
        assert fits(log) == expected
        answers[name] = (here / name / "tiny.csv").read_bytes()
    assert answers["off"] == answers["cold"] == answers["warm"]
    for seed in (0, 1):
        assert done.stderr.count(f"encoder typical-s{seed} restored: it learned this before") == 1
    for trace in (here / "off" / "tiny.traces").rglob("*.parquet"):
        assert trace.read_bytes() == Path(str(trace).replace("/off/", "/warm/")).read_bytes()


def test_a_store_that_cannot_be_written_is_told_once(here: Path, log: Path, vprbench: Run) -> None:
    (here / "file").touch()
    done = vprbench("sweep", "tiny.toml", "--cache", "file", "--filter", "Tiny/*/s0", "--jobs", "1")
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("encoder not stored: ") == 1
    assert fits(log) == 2


def test_one_agent_alone_takes_it_too(here: Path, log: Path, vprbench: Run) -> None:
    agent = 'localizer = "nearest-view", encoder = "typical"'
    done = [vprbench("run", "Tiny", agent, "--routes", "routes.toml", "--cache", "cache") for _ in range(2)]
    assert fits(log) == 1
    assert done[0].stdout == done[1].stdout != ""
    assert "encoder typical-s0 restored" in done[1].stderr
