"""`vprbench reproduce` from end to end on streets: everything it leaves, what it says, and that it goes on."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from vprbench.cli import main

THIRD_PARTY = Path(__file__).parents[2] / "third_party"

STUDIES = """
[[studies]]
name = "fits"
kind = "fit"
title = "Fits"
encoders = ["mean-patch"]
seeds = [0, 1]
routes = ["KITTI-K5-1", "Street-Wide"]

[[studies]]
name = "tiny"
kind = "sweep"
sweep = "tiny.toml"
title = "Tiny"
claims = true

[[studies.figures]]
stem = "tiny-by-route"
title = "Tiny"
by = "route"

[[studies.figures]]
stem = "unmeasured"
title = "Nothing of this is here"
routes = ["KITTI-K5-1"]

[[studies]]
name = "nothing"
kind = "sweep"
sweep = "nothing.toml"
title = "Nothing"

[[studies]]
name = "speed"
kind = "frequency"
title = "Speed"
agents = ["LPMP"]
places = [1, 3]
rounds = 1
routes = ["Street-Wide"]

[[studies]]
name = "fields"
kind = "place-fields"
title = "Fields"
agent = { localizer = "thumbnail" }
label = "thumbnail"
sampling_distance = 20
routes = ["Street-Wide"]
"""
SWEEP = """
routes = ["Tiny", "KITTI-K5-1"]
sampling_distances = [5]
routes_file = "routes/tiny.toml"
[agents]
thumbnail = "thumbnail"
"""
NOTHING = 'routes = ["KITTI-K5-1"]\nsampling_distances = [5]\n[agents]\nthumbnail = "thumbnail"\n'
ROUTES = '[routes.Tiny]\nreader = "street"\nenvironment = "wide"\nlength = 20\n'

Tell = Callable[..., tuple[int, str]]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with studies, and a machine without data."""
    (tmp_path / "asked" / "routes").mkdir(parents=True)
    (tmp_path / "data").mkdir()
    for name, text in (("studies", STUDIES), ("tiny", SWEEP), ("nothing", NOTHING), ("routes/tiny", ROUTES)):
        (tmp_path / "asked" / f"{name}.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("VPRBENCH_DATA", str(tmp_path / "data"))
    monkeypatch.setenv("PYTHONPATH", str(THIRD_PARTY))
    monkeypatch.syspath_prepend(str(THIRD_PARTY))
    return tmp_path


@pytest.fixture
def tell(here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Tell:
    """Run reproduce in this process; its exit code and what it told on the side."""

    def run(*words: str) -> tuple[int, str]:
        options = ["--file", "asked/studies.toml", "--out", "paper", "--jobs", "1", "--cache", "none"]
        monkeypatch.setattr(sys, "argv", ["vprbench", "reproduce", *words, *options])
        with pytest.raises(SystemExit) as ended:
            main()
        return int(ended.value.code or 0), capsys.readouterr().err

    return run


def line(said: str, study: str) -> str:
    """How a study ended."""
    return [text for text in said.splitlines() if text.startswith(f"{study}: ")][-1]


def test_everything_that_can_be_made_is_made_once_and_the_rest_is_told(here: Path, tell: Tell) -> None:
    code, said = tell("--dry-run")
    assert code == 0
    assert "1 of 1 cells to measure" in line(said, "tiny")
    assert all("to do" in line(said, name) for name in ("fits", "speed", "fields"))
    assert not (here / "paper").exists()

    code, said = tell()
    assert code == 0, said
    assert line(said, "fits") == "fits: done (on Street-Wide; without KITTI-K5-1)"
    assert line(said, "tiny") == "tiny: done (1 cells; without KITTI-K5-1)"
    assert line(said, "nothing") == "nothing: could not be run (without KITTI-K5-1)"
    assert line(said, "fields") == "fields: done (on Street-Wide)"
    assert said.splitlines()[-1].startswith("KITTI-K5-1 needs frames")
    paper = here / "paper"
    assert len(pd.read_csv(paper / "fit.csv")) == len(json.loads((paper / "fit-timings.json").read_text())["fits"])
    assert list(pd.read_csv(paper / "tiny.csv")["status"]) == ["ok"]
    assert set(pd.read_csv(paper / "frequency.csv")["places"]) == {1, 3}
    fields = pd.read_csv(paper / "fields.csv")
    assert fields["route"].unique() == ["Street-Wide"]
    assert len(fields) == fields["place"].nunique() * fields["frame"].nunique()
    claims = pd.read_csv(paper / "claims.csv")
    assert claims.equals(pd.read_csv(paper / "tiny.claims.csv"))
    assert "not testable" in set(claims["verdict"].str[:12])
    page = (paper / "tiny.report" / "report.html").read_text()
    assert "What of the paper holds?" in page
    drawn = {path.name for path in (paper / "figures").glob("*.png")}
    assert {"fields.png", "frequency.png", "tiny-by-route-auc.png", "tiny-by-route-auc-all.png"} <= drawn
    assert not any("unmeasured" in name for name in drawn)

    before = {path: path.stat().st_mtime_ns for path in paper.rglob("*") if path.suffix in (".csv", ".html", ".json")}
    code, said = tell()
    assert code == 0
    assert all("already there" in line(said, name) for name in ("fits", "speed", "fields"))
    assert "0 cells to measure" in said
    assert {path: path.stat().st_mtime_ns for path in before} == before

    (paper / "tiny.csv").unlink()
    (paper / "fit-timings.json").unlink()
    code, said = tell("fits", "tiny", "--dry-run")
    assert "to do" in line(said, "fits")
    assert "to do" in line(said, "tiny")
    assert "fields:" not in said


def test_a_fault_in_one_study_is_told_and_the_others_go_on(here: Path, tell: Tell) -> None:
    broken = SWEEP.replace('thumbnail = "thumbnail"', 'thumbnail = "thumbnial"')
    (here / "asked" / "tiny.toml").write_text(broken)
    code, said = tell("tiny", "fits")
    assert code == 1
    assert "did you mean 'thumbnail'" in line(said, "tiny")
    assert "done" in line(said, "fits")


def test_a_misspelt_study_is_told(tell: Tell) -> None:
    code, said = tell("tinny")
    assert code == 2
    assert "did you mean 'tiny'" in said
