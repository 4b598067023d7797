"""`vprbench frequency`: what it leaves behind, what it says, and what it refuses."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd
import pytest

from vprbench.cli import main
from vprbench.cli.timing_summary import remarks
from vprbench.cli.timing_words import asked_agents
from vprbench.frequency.question import default_question
from vprbench.frequency.rounds import play_rounds
from vprbench.frequency.table import COLUMNS
from vprbench.plugins import find

THIRD_PARTY = Path(__file__).parents[1] / "third_party"

ROUTES = '[routes.Street]\nreader = "street"\nenvironment = "narrow"\nlength = 20\n'


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


Run = Callable[..., Told]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "routes.toml").write_text(ROUTES)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(THIRD_PARTY))
    monkeypatch.setenv("COLUMNS", "200")
    return tmp_path


@pytest.fixture
def frequency(here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run `vprbench frequency` on a short street, in this process."""

    def run(*words: str) -> Told:
        common = ["--route", "Street", "--routes", "routes.toml", "--out", "out"]
        monkeypatch.setattr(sys, "argv", ["vprbench", "frequency", *words, *common])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run


def rows() -> list[dict[str, str]]:
    with Path("out/frequency.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_agents_and_places_become_rows_with_their_times(frequency: Run) -> None:
    pytest.importorskip("matplotlib")
    own = 'localizer = "nearest-view", encoder = "mean-patch"'
    done = frequency("lpmp", "CoHOG", "thumbnail", own, "--places", "30,1,5", "--rounds", "2", "--figures")
    assert done.code == 0, done.err
    agents = ("LPMP", "CoHOG", "thumbnail", "nearest-view(mean-patch)")
    assert [(row["agent"], row["places"]) for row in rows()] == [(a, n) for a in agents for n in ("1", "5", "30")]
    assert tuple(rows()[0]) == COLUMNS
    for row in rows():
        low, middle, high = (float(row[f"query_ms{end}"]) for end in ("_q1", "", "_q3"))
        assert 0 < low <= middle <= high
        assert float(row["hz"]) == pytest.approx(1000 / middle, rel=1e-4)
        # One that offers neither an encoder nor `describe` is timed as a whole.
        assert row["encode_ms"] == "" if row["agent"] == "thumbnail" else float(row["encode_ms"]) > 0
        assert (row["route"], row["rounds"]) == ("Street", "2")
    assert rows()[2]["filled_from"].startswith("learn ")
    stamp = json.loads(Path("out/frequency.json").read_text())
    assert stamp["agents"]["LPMP"] == {
        "config": {"encoder": {"name": "log-polar"}, "localizer": "max-pi"},
        "plugins": "vprbench 0.1.0",
    }
    assert {"processor", "cores", "commit"} <= stamp["machine"].keys()
    assert {"order", "filled_from", "queries", "warm-up"} <= stamp["rules"].keys()
    assert {path.name for path in Path("out/figures").iterdir()} == {"frequency.png", "frequency.svg"}
    assert "Street: queries a second, median of 2 rounds" in done.out
    shown = next(line.split() for line in done.out.splitlines() if line.split()[:1] == ["30"])
    # Four digits are shown, of more than the table keeps.
    assert list(map(float, shown[1:])) == pytest.approx(
        [float(r["hz"]) for r in rows() if r["places"] == "30"], rel=1e-3
    )
    assert "is cheaper than LPMP" in done.out


def test_finished_rounds_survive_an_interruption(frequency: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def played(*arguments: Any) -> Iterator[Sequence[Any]]:  # noqa: ANN401
        yield next(play_rounds(*arguments))
        raise KeyboardInterrupt

    monkeypatch.setattr("vprbench.cli.timing.play_rounds", played)
    done = frequency("thumbnail", "--places", "2", "--rounds", "3")
    assert done.code == 130
    assert "interrupted: 1 finished rounds are kept" in done.err
    assert [row["rounds"] for row in rows()] == ["1"]


def test_an_earlier_table_stays_until_a_round_is_finished(frequency: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def played(*arguments: object) -> Iterator[Sequence[Any]]:
        raise KeyboardInterrupt
        yield

    frequency("thumbnail", "--places", "2", "--rounds", "1")
    before = Path("out/frequency.csv").read_bytes()
    monkeypatch.setattr("vprbench.cli.timing.play_rounds", played)
    assert frequency("thumbnail", "--places", "3", "--rounds", "1").code == 130
    assert Path("out/frequency.csv").read_bytes() == before


def test_places_that_an_agent_does_not_make_are_told(frequency: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    thumbnail: Any = find("localizer", "thumbnail").load()
    good = thumbnail.learn
    monkeypatch.setattr(thumbnail, "learn", lambda self, seen: good(self, seen) if seen["gps"][1] < 9 else None)
    done = frequency("thumbnail", "--places", "2,50", "--rounds", "1")
    assert done.code == 0, done.err
    assert [row["places"] for row in rows()] == ["2"]
    assert "thumbnail makes no more places of the frames present: not timed with 50" in done.err


def test_the_papers_agents_are_there_by_their_names() -> None:
    question = default_question()
    named = dict(asked_agents(["hsd-15/30", "Lpmp", "cohog"], question))
    assert list(named) == ["HSD-15-30", "LPMP", "CoHOG"]
    assert dict(asked_agents([], question)) == question.agents
    assert question.reference in question.agents
    assert {point.agent for point in question.paper} <= question.agents.keys()
    assert list(question.places) == [1, 5, 10, 15, 50, 100, 150, 500, 1000]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["hsd-14"], "no agent 'hsd-14': did you mean 'hsd-"),
        (["localizer = 'max-pi', encoder = 'hsd-14'"], "no encoder is called 'hsd-14'"),
        (["localizer = "], "agent 'localizer = ': not the inside of a TOML table"),
        (["lpmp", "--places", "1,few"], "--places '1,few': give whole numbers from 1 on with commas between"),
        (["lpmp", "--places", ""], "--places '': give whole numbers from 1 on"),
        (["lpmp", "--places", "0,1"], "--places '0,1': give whole numbers from 1 on"),
    ],
)
def test_a_fault_of_the_question_is_one_line(frequency: Run, words: list[str], said: str) -> None:
    done = frequency(*words)
    assert done.code != 0
    assert done.err.startswith("vprbench: ")
    assert said.lower() in done.err.lower()
    assert len(done.err.splitlines()) == 1


def test_figures_without_their_extra_are_told_before_anything_runs(
    frequency: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vprbench.cli.timing.find_spec", lambda name: None)
    done = frequency("lpmp", "--figures")
    assert done.err == "vprbench: --figures needs matplotlib: pip install 'vprbench[figures]'\n"
    assert not Path("out").exists()


def told(**columns: object) -> list[str]:
    row = {"agent": "LPMP", "places": 5, "cpu_per_wall": 1.0, "parts_per_query": 1.0, "filled_from": "learn 5"}
    return list(remarks(pd.DataFrame([row | columns])))


def test_what_is_out_of_the_ordinary_is_said() -> None:
    assert told() == told(parts_per_query=float("nan")) == []
    assert "works on more than one thread (CPU time 1.9 of the clock's)" in told(cpu_per_wall=1.9)[0]
    assert "the machine was busy" in told(cpu_per_wall=0.5)[0]
    assert "do not add up to the query's time within 15 %: LPMP 5" in told(parts_per_query=1.3)[0]
    assert told(filled_from="learn 3, again 2") == [
        "from 5 places on, frames stand for several places (column filled_from)"
    ]
