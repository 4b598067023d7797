"""Three whole small routes, one of each layout, and the command line to play them with."""

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
from vprbench.runner import run
from vprbench.sweep import jobs, parse_sweep

THIRD_PARTY = Path(__file__).parents[2] / "third_party"

KITTI = '[routes.Road]\nreader = "kitti-{}"\nlearn = "00:0-9"\ntest = "00:15-24"\n'
OWN = '[routes.Road]\nreader = "folder"\nlearn = "day1"\ntest = "day2"\ncamera = { field_of_view_deg = 82.0 }\n'
QUESTION = """
routes = ["Road"]
sampling_distances = [2]
routes_file = "routes.toml"
[agents]
one = { localizer = "thumbnail" }
two = { localizer = "thumbnail", shrink = 8 }
"""
HEADER = "file,time,latitude,longitude,heading_deg\n"


@pytest.fixture
def odometry(odometry_tree: Path) -> Path:
    """A folder with routes.toml and its data: KITTI odometry."""
    (odometry_tree / "routes.toml").write_text(KITTI.format("odometry"))
    return odometry_tree


@pytest.fixture
def raw(raw_tree: Path) -> Path:
    """The same for KITTI raw."""
    (raw_tree / "routes.toml").write_text(KITTI.format("raw"))
    return raw_tree


@pytest.fixture(scope="session")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two drives of one's own, 0.7 m apart, 1.1 m a frame, and what a sweep of two agents left of them."""
    folder = tmp_path_factory.mktemp("whole")
    for day, longitude in (("day1", "8.40000"), ("day2", "8.40001")):
        (folder / day / "img").mkdir(parents=True)
        for frame in range(4):
            image = np.random.default_rng(frame).integers(0, 256, (100, 200), np.uint8)
            assert cv2.imwrite(str(folder / day / "img" / f"{frame}.png"), image)
        rows = (f"img/{frame}.png,{frame}.0,49.0000{frame},{longitude},0\n" for frame in range(4))
        (folder / day / "frames.csv").write_text(HEADER + "".join(rows))
    (folder / "routes.toml").write_text(OWN)
    (folder / "answers.toml").write_text(QUESTION)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(THIRD_PARTY))
        sweep, table = parse_sweep(folder / "answers.toml"), ResultTable(folder, "answers")
        for job in jobs(sweep, list(sweep.cells())):
            for outcome in run(job, None, folder / "routes.toml"):
                table.add(outcome)
    return folder


@pytest.fixture
def own(whole: Path, tmp_path: Path) -> Path:
    """The same as `odometry` for drives of one's own; answers.csv, its traces and answers.toml lie there too."""
    return Path(shutil.copytree(whole, tmp_path, dirs_exist_ok=True))


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def tell(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """Run a command in this process; whatever but an exit it ends with fails the test."""
    monkeypatch.syspath_prepend(str(THIRD_PARTY))
    monkeypatch.setenv("COLUMNS", "200")

    def run(*words: str | Path) -> Told:
        monkeypatch.setattr(sys, "argv", ["vprbench", *map(str, words)])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run
