"""The results of a small sweep on two short drives: two agents with awkward names, and a cell that failed."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
import pytest

from vprbench.cli import main
from vprbench.results import ResultTable
from vprbench.runner import failure, run
from vprbench.sweep import Cell, Job

THIRD_PARTY = Path(__file__).parents[2] / "third_party"

ROUTE = """
[routes.{name}]
reader = "folder"
learn = "learn"
test = "test-{name}"
camera = {{ field_of_view_deg = 82.0 }}
environment = "meadow"
"""
QUESTION = """description = "Does <size> matter?"
routes = ["Tiny", "Wee"]
sampling_distances = [2, 5]
routes_file = "routes.toml"

[agents]
"<script>alert('$1$')" = { localizer = "thumbnail", gain = 0.5 }
"_plain" = { localizer = "thumbnail" }
"""
AGENTS: dict[str, dict[str, object]] = {
    "<script>alert('$1$')": {"localizer": "thumbnail", "gain": 0.5},
    "_plain": {"localizer": "thumbnail", "shrink": 32},
}
FAILED = Cell("Tiny", "broken", 2.0, 0)
ERROR = "no <b>such</b> luck"


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


def drive(folder: Path, north: np.ndarray, noise: float) -> None:
    """A drive north past a long random texture, photographed through so much noise."""
    rng = np.random.default_rng(7)
    coarse = rng.integers(0, 255, (12, 60), dtype=np.uint8)
    wall = cv2.resize(coarse, (1200, 38), interpolation=cv2.INTER_CUBIC).astype(float)
    folder.mkdir()
    lines = ["file,time,east,north,heading_deg"]
    for frame, metres in enumerate(north):
        view = wall[:, int(30 * metres) :][:, :128] + noise * rng.normal(size=(38, 128))
        assert cv2.imwrite(str(folder / f"{frame}.png"), view.clip(0, 255).astype(np.uint8))
        lines.append(f"{frame}.png,{frame},{noise / 100},{metres:.3f},0")
    (folder / "frames.csv").write_text("\n".join(lines) + "\n")


@pytest.fixture(scope="session")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with the sweep's question, routes and answer."""
    folder = tmp_path_factory.mktemp("report") / "results"
    folder.mkdir()
    drive(folder / "learn", np.arange(0.0, 30.0), 0.0)
    for name, noise in (("Tiny", 60.0), ("Wee", 90.0)):
        drive(folder / f"test-{name}", np.arange(0.3, 29.0, 1.1), noise)
    (folder / "routes.toml").write_text("".join(ROUTE.format(name=name) for name in ("Tiny", "Wee")))
    table = ResultTable(folder, "small")
    table.question.write_text(QUESTION)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(THIRD_PARTY))
        for route in ("Tiny", "Wee"):
            for agent, config in AGENTS.items():
                cells = tuple(Cell(route, agent, distance, 0) for distance in (2.0, 5.0))
                for outcome in run(Job(route, agent, 0, config, cells), None, folder / "routes.toml"):
                    assert outcome.row["status"] == "ok", outcome.row["error"]
                    table.add(outcome)
        table.add(failure(Job("Tiny", "broken", 0, {"localizer": "thumbnail"}, (FAILED,)), FAILED, ERROR))
    return folder


@pytest.fixture
def results(tmp_path: Path, measured: Path) -> ResultTable:
    """A copy of the answer, to be read and damaged."""
    shutil.copytree(measured, tmp_path / "results")
    return ResultTable(tmp_path / "results", "small")


@pytest.fixture
def tell(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """Run a command in this process."""

    def ask(*words: object) -> Told:
        monkeypatch.setattr(sys, "argv", ["vprbench", *map(str, words)])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return ask
