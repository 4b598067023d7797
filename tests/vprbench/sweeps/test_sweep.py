"""Sweeps from the command line: whole, resumed, changed, failing; always the same table."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pandas as pd
from filelock import FileLock

from vprbench.results import read_table

Run = Callable[..., subprocess.CompletedProcess[str]]
Ask = Callable[[dict[str, str]], None]

GOOD = 'localizer = "thumbnail"'
OTHER = 'localizer = "nearest-view", encoder = "mean-patch"'


def test_a_sweep_answers_its_question_and_goes_on_where_it_stopped(here: Path, vprbench: Run) -> None:
    results = here / "runs"
    first = vprbench("sweep", "tiny.toml", "--jobs", "1")
    assert first.returncode == 0, first.stderr
    table = pd.read_csv(results / "tiny.csv")
    assert len(table) == 8
    assert (table["status"] == "ok").all()
    assert (table["plugins"] == "acme-vpr 1.2").all()
    assert (results / "tiny.toml").read_text() == (here / "tiny.toml").read_text()
    assert len(list((results / "tiny.traces").rglob("*.parquet"))) == 8
    assert pd.read_parquet(results / "tiny.parquet")["auc"].equals(table["auc"])

    answer = (results / "tiny.csv").read_bytes()
    again = vprbench("sweep", "tiny.toml")
    assert "0 cells to measure" in again.stderr
    assert "8 already there" in again.stderr
    assert (results / "tiny.csv").read_bytes() == answer

    next((results / "tiny.traces").rglob("*.parquet")).unlink()
    assert "1 cells to measure" in vprbench("sweep", "tiny.toml", "--dry-run").stderr

    other = vprbench("sweep", "tiny.toml", "--jobs", "2", "--out", "other")
    assert other.returncode == 0, other.stderr
    assert (here / "other" / "tiny.csv").read_bytes() == answer
    assert "8 of 8 cells agree" in vprbench("score", "other/tiny.csv").stdout
    assert "thumbnail" in vprbench("table", "other/tiny.csv", "--format", "markdown").stdout

    (here / "other" / "tiny.csv").write_text(answer.decode().replace("0.5", "0.4"))
    assert vprbench("score", "other/tiny.csv").returncode == 1


def test_rogues_fail_alone(here: Path, vprbench: Run, ask: Ask) -> None:
    rogues = {name: f'localizer = "{name}"' for name in ("dies", "hangs", "raises")}
    ask({**rogues, "broken": 'localizer = "nearest-view", encoder = "broken-patch"', "good": GOOD})
    done = vprbench("sweep", "tiny.toml", "--jobs", "2", "--timeout", "20")
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    table = pd.read_csv(here / "runs" / "tiny.csv").set_index("agent")
    assert table["status"].to_dict() == {"good": "ok"} | dict.fromkeys([*rogues, "broken"], "failed")
    error = table["error"].astype(str)
    assert "worker process died" in error["dies"]
    assert "timed out" in error["hangs"]
    assert "no such luck" in error["raises"]
    assert "broken-patch" in error["broken"]
    assert "acme-vpr" in error["broken"]


def test_a_dry_run_tells_which_jobs_will_fail(here: Path, vprbench: Run, ask: Ask) -> None:
    ask({"raises": 'localizer = "raises"', "broken": 'localizer = "nearest-view", encoder = "broken-patch"', "b": GOOD})
    done = vprbench("sweep", "tiny.toml", "--dry-run")
    assert done.returncode == 0
    assert "Traceback" not in done.stderr
    assert "Tiny/raises/s0: ValueError: no such luck" in done.stdout
    assert "Tiny/broken/s0: " in done.stdout
    assert "acme-vpr" in done.stdout
    assert "; 2 of 3 jobs will fail, for the reasons above" in done.stdout


def test_a_mended_failure_leaves_no_mark(here: Path, vprbench: Run, ask: Ask) -> None:
    """Names that look like nothing or like numbers are names, and a failed row changes no other."""
    csv = here / "runs" / "tiny.csv"
    ask({"NA": GOOD, "1e5": 'localizer = "raises"'})
    assert vprbench("sweep", "tiny.toml", "--jobs", "1").returncode == 1
    assert read_table(csv)["agent"].tolist() == ["1e5", "NA"]
    ask({"NA": GOOD, "1e5": OTHER})
    assert vprbench("sweep", "tiny.toml", "--jobs", "1").returncode == 0
    assert vprbench("sweep", "tiny.toml", "--jobs", "1", "--out", "fresh").returncode == 0
    assert csv.read_bytes() == (here / "fresh" / "tiny.csv").read_bytes()


def test_a_failure_replaces_no_answer(here: Path, vprbench: Run, ask: Ask) -> None:
    ask({"a": GOOD})
    assert vprbench("sweep", "tiny.toml", "--jobs", "1").returncode == 0
    answer = (here / "runs" / "tiny.csv").read_bytes()
    failed = vprbench("sweep", "tiny.toml", "--jobs", "1", "--overwrite", "--timeout", "0.01")
    assert failed.returncode == 1
    assert "timed out" in failed.stderr
    assert (here / "runs" / "tiny.csv").read_bytes() == answer


def test_what_changed_is_measured_again(here: Path, vprbench: Run, ask: Ask) -> None:
    ask({"a": GOOD, "b": OTHER})
    assert vprbench("sweep", "tiny.toml", "--jobs", "1").returncode == 0
    ask({"a": GOOD, "b": OTHER + ", floor = 0.1"})
    again = vprbench("sweep", "tiny.toml", "--dry-run")
    assert "1 cells to measure" in again.stderr
    assert "1 of them because" in again.stderr
    routes = (here / "routes.toml").read_text()
    (here / "routes.toml").write_text(routes.replace('"narrow"', '"wide"'))
    again = vprbench("sweep", "tiny.toml", "--dry-run")
    assert "2 cells to measure" in again.stderr
    assert "seconds" in again.stdout


def test_rows_without_a_question_are_set_aside(here: Path, vprbench: Run, ask: Ask) -> None:
    ask({"a": GOOD})
    assert vprbench("sweep", "tiny.toml", "--jobs", "1").returncode == 0
    ask({"renamed": GOOD})
    again = vprbench("sweep", "tiny.toml", "--jobs", "1")
    assert "1 rows that answer no cell of this sweep go to tiny.previous.csv" in again.stderr
    assert read_table(here / "runs" / "tiny.csv")["agent"].tolist() == ["renamed"]
    assert read_table(here / "runs" / "tiny.previous.csv")["agent"].tolist() == ["a"]


def test_two_sweeps_do_not_write_one_table(here: Path, vprbench: Run) -> None:
    (here / "runs").mkdir()
    with FileLock(here / "runs" / ".tiny.lock"):
        done = vprbench("sweep", "tiny.toml", "--jobs", "1")
    assert done.returncode == 2
    assert "another sweep is writing" in done.stderr


def test_another_question_is_not_overwritten(here: Path, vprbench: Run) -> None:
    (here / "k0-2.toml").write_text("a question of my own")
    done = vprbench("sweep", "k0-2", "--out", ".")
    assert done.returncode == 2
    assert (here / "k0-2.toml").read_text() == "a question of my own"
