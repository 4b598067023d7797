"""What a sweep left, broken: each command that reads it says so in one line, and nothing measured is lost."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from vprbench.errors import DataError
from vprbench.results import ResultTable
from vprbench.runner import Outcome, run
from vprbench.sweep import Cell, jobs, parse_sweep

Tell = Callable[..., Any]
Break = Callable[[Path], object]

CSV, PARQUET, TRACE = "answers.csv", "answers.parquet", "answers.traces/Road/2m/one/s0.parquet"


@pytest.fixture
def answers(own: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with the results of two agents."""
    monkeypatch.chdir(own)
    return own


def cell(column: str, value: str) -> Break:
    """Another value in the first row of the CSV."""

    def breaks(path: Path) -> None:
        rows = pd.read_csv(path, dtype=str, keep_default_na=False)
        rows.loc[0, column] = value
        rows.to_csv(path, index=False)

    return breaks


def edit(change: Callable[[bytes], bytes]) -> Break:
    return lambda path: path.write_bytes(change(path.read_bytes()))


def column(name: str, change: Callable[[pd.Series], Any]) -> Break:
    """Another column in a Parquet file."""

    def breaks(path: Path) -> None:
        rows = pd.read_parquet(path)
        rows[name] = change(rows[name])
        rows.to_parquet(path)

    return breaks


def folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def circle(path: Path) -> None:
    path.unlink()
    path.symlink_to(path)


NOT_OF = "is not of its route, distance, agent and seed"
TABLES: list[tuple[str, Break, str]] = [
    (CSV, edit(lambda c: c[:-200]), "answers.csv, line 3: "),
    (CSV, edit(lambda c: c[: len(c) // 2 + 40]), "answers.csv, line "),
    (CSV, edit(lambda c: c + b"1,2,3\n"), "answers.csv, line 4: 3 values for "),
    (CSV, edit(lambda c: b""), "answers.csv: the file is empty"),
    (CSV, edit(lambda c: c.replace(b"Road", b"R\xf6d", 1)), "answers.csv, line 2: not UTF-8"),
    (CSV, edit(lambda c: c.replace(b"Road", b"R\0d", 1)), "answers.csv, line 2: holds a NUL"),
    (CSV, edit(lambda c: c.replace(b"Road", b'"Road', 1)), "answers.csv, line "),
    (
        CSV,
        edit(lambda c: c.replace(b",auc_all,", b",auc_oll,", 1)),
        "answers.csv: not readable as a result table: it has",
    ),
    (CSV, edit(lambda c: c.replace(b",auc_all,", b",auc,", 1)), "answers.csv: not readable as a result table: "),
    (CSV, edit(lambda c: c.replace(b",", b";")), "answers.csv: not readable as a result table: it has no column"),
    (CSV, folder, "answers.csv: cannot be read (Is a directory)"),
    (CSV, circle, "answers.csv: not readable as a result table: there is no such file; run its sweep first"),
    (CSV, cell("auc", "0,5"), "answers.csv: not readable as a result table: row 1: auc is '0,5', not a number"),
    (CSV, cell("auc", "inf"), "row 1: auc is 'inf', not a number"),
    (CSV, cell("auc", "1e300"), "row 1: auc is '1e300', not a number"),
    (CSV, cell("seed", "0.5"), "row 1: seed is '0.5', not a whole number"),
    (CSV, cell("seed", "1" + "0" * 30), "not a whole number"),
    (CSV, cell("seed", ""), f"row 1: cell 'Road/2m/one/s0' {NOT_OF}"),
    (CSV, cell("sampling_distance_m", "-2"), f"row 1: cell 'Road/2m/one/s0' {NOT_OF}"),
    (CSV, cell("cell", "../../x"), f"row 1: cell '../../x' {NOT_OF}"),
    (CSV, cell("cell", "x" * 5000), NOT_OF),
    (PARQUET, edit(lambda c: c[:-30]), "answers.parquet: not readable as a result table"),
    (PARQUET, edit(lambda c: b""), "answers.parquet: not readable as a result table"),
    (PARQUET, edit(lambda c: b"a,b\n1,2\n"), "answers.parquet: not readable as a result table"),
    (PARQUET, circle, "answers.parquet: not readable as a result table"),
    (
        PARQUET,
        column("auc", lambda c: [[1.0]] * len(c)),
        "row 1: auc is array([1.]), not a number",
    ),
]

TRACES: list[tuple[Break, str]] = [
    (edit(lambda c: c[:-30]), ""),
    (edit(lambda c: b""), ""),
    (edit(lambda c: c[: len(c) // 2] + bytes([c[len(c) // 2] ^ 255]) + c[len(c) // 2 + 1 :]), ""),
    (folder, ""),
    (column("confidence", lambda c: c * np.nan), "trace: confidence is not a number from 0 up"),
    (column("east", lambda c: c + np.inf), "trace: east is not a number of metres"),
    (column("north", lambda c: c + 1e300), "trace: north is not a number of metres"),
    (column("tolerance_m", lambda c: c * np.nan), "trace: tolerance_m is not a number of metres"),
    (column("frame", lambda c: c.astype(str)), "trace: frame holds object values, not int64"),
]


@pytest.mark.parametrize(("name", "breaks", "said"), TABLES)
def test_a_broken_table_is_told_by_every_command_that_reads_it(
    answers: Path, tell: Tell, name: str, breaks: Break, said: str
) -> None:
    breaks(answers / name)
    for command in ("table", "score", "compare", "report"):
        done = tell(command, name)
        assert said in done.err, command
        assert (len(done.err.splitlines()), done.code) == (1, 3), command


@pytest.mark.parametrize(("breaks", "said"), TRACES)
def test_a_broken_trace_is_told(answers: Path, tell: Tell, breaks: Break, said: str) -> None:
    breaks(answers / TRACE)
    scored, compared = tell("score", CSV), tell("compare", CSV)
    assert (scored.code, compared.code) == (1, 3)
    assert f"Road/2m/one/s0: {TRACE}: not a readable trace ({said}" in scored.out
    assert f"{TRACE}: not a readable trace ({said}" in compared.err
    assert len(compared.err.splitlines()) == 1
    assert "1 of 2 cells agree" in scored.out


def test_a_configuration_that_is_no_json_is_told(answers: Path, tell: Tell) -> None:
    cell("agent_config", "{bad")(answers / CSV)
    done = tell("report", CSV)
    assert (done.code, len(done.err.splitlines())) == (3, 1)
    assert "agent_config '{bad' of the results is no JSON" in done.err


def test_rows_that_were_measured_outlive_a_frame_that_breaks(answers: Path, tell: Tell) -> None:
    """As a sweep takes them from its workers; `tell` knows where the agents are."""
    before = (answers / CSV).read_bytes()
    broken = answers / "day2" / "img" / "2.png"
    broken.write_bytes(broken.read_bytes()[:-20])
    sweep, table = parse_sweep(answers / "answers.toml"), ResultTable(answers, "answers")
    for job in jobs(sweep, list(sweep.cells())):
        for outcome in run(job, None, answers / "routes.toml"):
            assert outcome.row["error"] == f"DataError: {broken}: the PNG is cut off; fetch the file again"
            table.add(outcome)
    assert (answers / CSV).read_bytes() == before


def test_rows_that_were_measured_outlive_a_trace_that_cannot_be_written(answers: Path) -> None:
    """A file is in the way of a new agent's trace."""
    before = (answers / CSV).read_bytes()
    (answers / "answers.traces" / "Road" / "2m" / "three").touch()
    table, cell = ResultTable(answers, "answers"), Cell("Road", "three", 2.0, 0)
    earlier = table.row(Cell("Road", "one", 2.0, 0))
    assert earlier is not None
    outcome = Outcome(cell, earlier | {"cell": cell.id, "agent": "three"}, table.trace("Road/2m/one/s0"))
    with pytest.raises(DataError, match=r"three/s0\.parquet: the trace cannot be written \("):
        table.add(outcome)
    assert (answers / CSV).read_bytes() == before
    assert ResultTable(answers, "answers").frame()["agent"].tolist() == ["one", "two"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root writes where the bits forbid it; a file in the way is tried above")
def test_a_folder_that_may_only_be_read_is_told(answers: Path, tell: Tell) -> None:
    answers.chmod(0o555)
    try:
        done = tell("sweep", "answers.toml", "--out", ".", "--overwrite")
        reported = tell("report", CSV)
    finally:
        answers.chmod(0o755)
    for told in (done, reported):
        assert told.code == 3
        assert "cannot" in told.err.splitlines()[-1]


def test_a_report_that_cannot_be_written_is_told(answers: Path, tell: Tell) -> None:
    shutil.copy(answers / CSV, answers / "answers.report")
    done = tell("report", CSV)
    assert (done.code, len(done.err.splitlines())) == (3, 1)
    assert "answers.report: the report cannot be written (" in done.err
