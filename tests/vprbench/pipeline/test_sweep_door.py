"""The same agents through the command line: workers, tables and stored traces change nothing of what they score."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from vprbench.results import read_table

SITE = Path(__file__).parent / "site"

AGENTS = {
    "memory": 'localizer = "perfect-memory"',
    "cheat": 'localizer = "cheat"',
    "matrix": 'localizer = "cheat-by-matrix"',
    "zero": 'localizer = "one-place", recorded = "truth"',
    "peek": 'localizer = "peek"',
}
SCORES = ["auc", "auc_all", "accuracy", "extended_precision", "recall_at_1", "auc_low", "accuracy_low", "auc_high"]


def vprbench(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run a command in a process that sees the side door."""
    command = [sys.executable, "-m", "vprbench", *words]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(SITE), os.environ.get("PYTHONPATH", "")])}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=240)


@pytest.fixture(scope="module")
def table(routes: Path) -> Path:
    """The table of a sweep."""
    head = ['routes = ["Beside"]', "sampling_distances = [4, 5]", 'routes_file = "routes.toml"', "[agents]"]
    door = f"route = 'Beside', routes = '{routes}'"
    lines = [f"{name} = {{ {agent}, {door} }}" for name, agent in AGENTS.items()]
    (routes.parent / "known.toml").write_text("\n".join([*head, *lines]))
    done = vprbench(routes.parent, "sweep", "known.toml", "--jobs", "1")
    assert done.returncode == 1, done.stderr
    return routes.parent / "runs" / "known.csv"


def test_a_sweep_scores_the_agents_as_theory_says(table: Path) -> None:
    rows = {(row["agent"], row["sampling_distance_m"]): row for row in read_table(table).to_dict("records")}
    assert len(rows) == 10
    for distance in (4.0, 5.0):
        for name in ("memory", "cheat", "matrix"):
            row = rows[name, distance]
            assert row["status"] == "ok", row["error"]
            assert [row[score] for score in SCORES] == [1.0] * len(SCORES)
        assert rows["memory", distance]["auc_all_metric"] == 1.0
        zero = rows["zero", distance]
        assert 0 < zero["accuracy"] < 0.1
        assert zero["auc_all"] == pytest.approx(zero["accuracy"] * (1 + zero["accuracy"]) / 2, abs=1e-6)
        assert rows["peek", distance]["status"] == "failed"
        assert "gps" in str(rows["peek", distance]["error"])


def test_the_stored_answers_score_the_same_again(table: Path) -> None:
    again = vprbench(table.parent, "score", table.name)
    assert again.returncode == 0, again.stdout
    assert "8 of 8 cells agree" in again.stdout
