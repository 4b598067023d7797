"""`vprbench scale`: what it leaves behind, what it says, and what it refuses."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from vprbench.cli import main
from vprbench.scale.growth import grow
from vprbench.scale.table import COLUMNS

ROUTES = '[routes.Street]\nreader = "street"\nenvironment = "narrow"\nlength = 20\n'


# Without calibration, for which many frames would have to be drawn.
LARGE, SMALL = (
    f'localizer = "max-pi", encoder = "{encoder}", recognition_threshold = 0.8'
    for encoder in ("log-polar", "log-polar-6")
)


class Told(NamedTuple):
    code: int
    out: str
    err: str


Run = Callable[..., Told]


@pytest.fixture
def scale(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run `vprbench scale` on a short street, in this process."""
    (tmp_path / "routes.toml").write_text(ROUTES)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setattr("vprbench.scale.city.FRAMES", 8)

    def run(*words: str) -> Told:
        common = ["--route", "Street", "--routes", "routes.toml", "--out", "out", "--queries", "3"]
        monkeypatch.setattr(sys, "argv", ["vprbench", "scale", *words, *common])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run


def rows() -> list[dict[str, str]]:
    with Path("out/scale.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_sizes_become_rows_until_a_limit_stops_the_agent(scale: Run) -> None:
    pytest.importorskip("matplotlib")
    done = scale(LARGE, SMALL, "--places", "100,5,20", "--gigabytes", "0.001", "--figures")
    assert done.code == 0, done.err
    assert tuple(rows()[0]) == COLUMNS
    large, small = (f"max-pi[recognition_threshold=0.8](log-polar{size})" for size in ("", "-6"))
    found = [(row["agent"], int(row["places"]), row["stopped"]) for row in rows()]
    assert found[0] == (large, 5, "")
    name, places, stopped = found[1]
    assert (name, places) == (large, 20)
    assert stopped.startswith("would hold 0.00")
    assert found[2:] == [(small, n, "") for n in (5, 20, 100)]
    for row in rows():
        if not row["stopped"]:
            assert 0 < float(row["query_ms_q1"]) <= float(row["query_ms"]) <= float(row["query_ms_q3"])
            assert (
                min(
                    float(row[name]) for name in ("bytes_per_place", "add_ms", "learn_ms", "respond_ms", "query_cpu_ms")
                )
                > 0
            )
            assert row["queries"] == "3"
    stamp = json.loads(Path("out/scale.json").read_text())
    assert {"processor", "cores", "commit"} <= stamp["machine"].keys()
    assert stamp["limits"] == {"gigabytes": 0.001, "seconds": 5.0}
    assert {path.name for path in Path("out/figures").iterdir()} == {"scale.png", "scale.svg"}
    assert f"{large} stops: 20 places {stopped}" in done.out
    assert any(line.split()[:2] == [small, "100"] for line in done.out.splitlines())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["hsd-14"], "no agent 'hsd-14'"),
        (["lpmp", "--places", "0"], "--places '0': give whole numbers from 1 on"),
        (["lpmp", "--places", ""], "--places '': give whole numbers from 1 on"),
    ],
)
def test_a_fault_of_the_question_is_one_line(scale: Run, words: list[str], said: str) -> None:
    done = scale(*words)
    assert done.code != 0
    assert done.err.startswith("vprbench: ")
    assert said in done.err
    assert len(done.err.splitlines()) == 1


def test_finished_sizes_survive_an_interruption(scale: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*arguments: object) -> object:
        yield next(iter(grow(*arguments)))  # type: ignore[arg-type]
        raise KeyboardInterrupt

    monkeypatch.setattr("vprbench.cli.scaling.grow", interrupted)
    done = scale(SMALL, "--places", "4,8")
    assert done.code == 130
    assert "interrupted: 1 finished sizes are kept" in done.err
    assert [row["places"] for row in rows()] == ["4"]
