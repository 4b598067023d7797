"""A sweep that is stopped keeps what it finished, leaves no process behind, and goes on to the same table."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

QUESTION = """
routes = ["Tiny"]
sampling_distances = [2, 5]
routes_file = "routes.toml"

[agents]
quick = { localizer = "thumbnail" }
slow = { localizer = "slow" }
"""


def start(here: Path, environment: dict[str, str]) -> subprocess.Popen[bytes]:
    """Start a sweep in a process group of its own, and wait for its first finished cell."""
    command = [sys.executable, "-m", "vprbench", "sweep", "tiny.toml", "--jobs", "1"]
    quiet = subprocess.DEVNULL
    running = subprocess.Popen(command, cwd=here, env=environment, start_new_session=True, stdout=quiet, stderr=quiet)
    deadline = time.monotonic() + 120
    while not (here / "runs" / "tiny.csv").exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    return running


def is_gone(group: int) -> bool:
    """Whether no process of the group is left; the last ones get a while to notice."""
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.2)
    return False


@pytest.mark.parametrize(("stop", "code"), [(signal.SIGINT, 130), (signal.SIGKILL, -signal.SIGKILL)])
def test_an_interruption_loses_no_finished_cell(
    here: Path,
    environment: dict[str, str],
    vprbench: Callable[..., subprocess.CompletedProcess[str]],
    stop: signal.Signals,
    code: int,
) -> None:
    csv = here / "runs" / "tiny.csv"
    (here / "tiny.toml").write_text(QUESTION)
    running = start(here, environment)
    running.send_signal(stop)
    assert running.wait(timeout=60) == code
    assert is_gone(running.pid)
    kept = len(pd.read_csv(csv))
    assert 1 <= kept < 4

    again = vprbench("sweep", "tiny.toml", "--jobs", "1")
    assert f"{kept} already there" in again.stderr
    assert vprbench("sweep", "tiny.toml", "--jobs", "2", "--out", "whole").returncode == 0
    assert csv.read_bytes() == (here / "whole" / "tiny.csv").read_bytes()
