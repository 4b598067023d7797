"""Sweeps on a machine that lacks some of their data, and results that are asked again from their own folder."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from vprbench.results import read_table

Run = Callable[..., subprocess.CompletedProcess[str]]
Tell = Callable[..., Any]

LACKING = '["Tiny", "KITTI-K5-1"]'


@pytest.fixture
def bare(here: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A question that asks for a drawn street and for a road of KITTI, whose frames are not here."""
    question = here / "tiny.toml"
    question.write_text(question.read_text().replace('["Tiny", "Tiny-2"]', LACKING))
    assert LACKING in question.read_text()
    (here / "empty").mkdir()
    monkeypatch.setenv("VPRBENCH_DATA", str(here / "empty"))
    return question


def test_what_is_left_out_is_told_with_the_reason(bare: Path, tell: Tell) -> None:
    done = tell("sweep", "tiny.toml", "--present", "--dry-run")
    assert done.code == 0
    assert "tiny: 4 cells to measure" in done.err
    assert "left out: KITTI-K5-1 needs" in done.err
    assert "0 of 242 are in" in done.err
    assert "`vprbench fetch KITTI-K5-1` gets what is missing." in done.err
    assert "KITTI-K5-1" not in done.out
    assert "left out" not in tell("sweep", "tiny.toml", "--dry-run", "--filter", "Tiny/2m").err


def test_with_no_data_at_all_there_is_nothing_to_do(bare: Path, tell: Tell) -> None:
    bare.write_text(bare.read_text().replace('["Tiny", ', "["))
    done = tell("sweep", "tiny.toml", "--present")
    assert done.code == 3
    assert "left out: KITTI-K5-1" in done.err
    assert "no route of this sweep" in done.err


def test_rows_of_a_route_that_is_left_out_stay(bare: Path, vprbench: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    assert vprbench("sweep", "tiny.toml", "--jobs", "1", "--filter", "thumbnail").returncode == 1
    table = bare.parent / "runs" / "tiny.csv"
    before = read_table(table).set_index("cell")
    assert (before.loc[before["route"] == "KITTI-K5-1", "status"] == "failed").all()
    assert vprbench("sweep", "tiny.toml", "--jobs", "1", "--present").returncode == 0
    after = read_table(table).set_index("cell")
    assert set(before.index) < set(after.index)
    assert (after.loc[after["route"] == "Tiny", "status"] == "ok").all()


def test_a_result_can_be_asked_again_from_its_own_folder(here: Path, vprbench: Run) -> None:
    (here / "routes").mkdir()
    (here / "routes.toml").rename(here / "routes" / "own.toml")
    question = here / "tiny.toml"
    question.write_text(question.read_text().replace("routes.toml", "routes/own.toml"))
    assert vprbench("sweep", "tiny.toml", "--jobs", "1", "--filter", "Tiny/2m/thumb").returncode == 0
    answer = (here / "runs" / "tiny.csv").read_bytes()
    question.unlink()
    (here / "routes" / "own.toml").unlink()
    again = vprbench("sweep", "runs/tiny.toml", "--filter", "Tiny/2m/thumb")
    assert again.returncode == 0, again.stderr
    assert "1 already there" in again.stderr
    assert (here / "runs" / "tiny.csv").read_bytes() == answer


def test_a_routes_file_outside_is_not_copied(here: Path, vprbench: Run) -> None:
    (here / "asked").mkdir()
    question = here / "asked" / "tiny.toml"
    question.write_text((here / "tiny.toml").read_text().replace('"routes.toml"', '"../routes.toml"'))
    untouched = (here / "routes.toml").stat().st_mtime_ns
    assert vprbench("sweep", str(question), "--jobs", "1", "--filter", "Tiny/2m/thumb").returncode == 0
    assert (here / "routes.toml").stat().st_mtime_ns == untouched
    assert not (here / "runs" / "routes.toml").exists()
