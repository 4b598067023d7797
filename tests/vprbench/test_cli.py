"""Commands that read what a sweep left, and those that measure little enough to run in this process."""

from __future__ import annotations

import io
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pandas as pd
import pytest
from rich.console import Console

from vprbench.cli import main
from vprbench.cli.progress import CELL_STAGES, SweepProgress
from vprbench.pool import Progress
from vprbench.results import ResultTable
from vprbench.runner import Outcome, run
from vprbench.sweep import Cell, Job, jobs, parse_sweep

THIRD_PARTY = Path(__file__).parents[1] / "third_party"

ROUTES = '[routes.Tiny]\nreader = "street"\nenvironment = "narrow"\nlength = 20\n'
QUESTION = """
description = "Does [size] matter?"
routes = ["Tiny"]
sampling_distances = [2, 5]
routes_file = "routes.toml"
[agents]
"a[size=3]" = { localizer = "thumbnail" }
"""


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a question whose agent has a name that looks like markup."""
    ask(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(THIRD_PARTY))
    return tmp_path


def ask(folder: Path) -> None:
    """Write the question and its routes."""
    (folder / "routes.toml").write_text(ROUTES)
    (folder / "tiny.toml").write_text(QUESTION)


@pytest.fixture
def tell(here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """Run a command in this process, on a terminal of 200 columns."""
    monkeypatch.setenv("COLUMNS", "200")

    def run(*words: str) -> Told:
        monkeypatch.setattr(sys, "argv", ["vprbench", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The question's answer, two cells, measured once."""
    folder = tmp_path_factory.mktemp("measured")
    ask(folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(THIRD_PARTY))
        sweep = parse_sweep(folder / "tiny.toml")
        table = ResultTable(folder / "results", "tiny")
        for job in jobs(sweep, list(sweep.cells())):
            for outcome in run(job, None, folder / "routes.toml"):
                assert outcome.row["status"] == "ok", outcome.row["error"]
                table.add(outcome)
    return table.folder


@pytest.fixture
def answered(here: Path, measured: Path) -> ResultTable:
    """A copy of the answer, to be read and damaged."""
    shutil.copytree(measured, here / "results")
    return ResultTable(Path("results"), "tiny")


def traces(table: ResultTable) -> list[Path]:
    """The files of the traces, in the order of the rows."""
    return [table.trace_path(cell) for cell in table.frame()["cell"]]


def test_names_in_brackets_are_printed_as_they_are(answered: ResultTable, tell: Callable[..., Told]) -> None:
    assert "a[size=3]" in tell("table", "results/tiny.csv").out
    assert "Tiny/a[size=3]/s0" in tell("sweep", "tiny.toml", "--overwrite", "--dry-run").out
    for trace in traces(answered):
        trace.unlink()
    assert "Tiny/5m/a[size=3]/s0: " in tell("score", "results/tiny.csv").out
    one = tell("run", "Tiny", 'localizer = "thumbnail", gain = 0.5', "--routes", "routes.toml", "--distance", "5")
    assert one.out.startswith("thumbnail[gain=0.5] on Tiny, a place every 5 m\n")


@pytest.mark.usefixtures("answered")
def test_a_step_is_known_without_describing_a_frame(tell: Callable[..., Told], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vprbench.cli.single.ResponseMatrix", lambda *given: pytest.fail("it described all frames"))
    done = tell("run", "Tiny", "cohog", "--routes", "routes.toml", "--distance", "5")
    assert "step 5: " in done.out


@pytest.mark.parametrize(
    ("stage", "answered", "shown"),
    [
        ("fit", 0, "2 %"),
        ("fitted", 0, "5 %"),
        ("compare frames", 0, "62 %"),
        ("calibrate", 0, "5 %"),
        ("calibrate", 1, "52 %"),
        ("play", 1, "90 %"),
    ],
)
def test_progress_moves_in_every_stage(stage: str, answered: int, shown: str) -> None:
    cells = Cell("Tiny", "a[size=3]", 2.0, 0), Cell("Tiny", "a[size=3]", 5.0, 0)
    job = Job("Tiny", "a[size=3]", 0, {"localizer": "thumbnail"}, cells)
    console = Console(width=120, file=io.StringIO(), force_terminal=True, color_system=None)
    with SweepProgress([job], console) as progress:
        progress.step(Progress(0, "fit", 0, 1))
        for cell in cells[:answered]:
            progress.finish(Outcome(cell, {"status": "failed", "error": "no [frame] there"}, None))
        progress.step(Progress(0, stage, 1 if stage not in CELL_STAGES else 0, 2, "S1 [1/2]"))
    said = console.file.getvalue()  # type: ignore[attr-defined]
    assert f"Tiny/a[size=3]/s0: {stage} S1 [1/2]" in said
    # What came of the fit is a line that stays, without a bar.
    assert ("           Tiny/a[size=3]/s0: S1 [1/2]\n" in said) == (stage == "fitted")
    assert shown in [line for line in said.splitlines() if stage in line][-1]
    assert ("1/2  Tiny/2m/a[size=3]/s0  failed: no [frame] there" in said) == bool(answered)


def test_a_table_that_agrees_with_its_traces_is_confirmed(answered: ResultTable, tell: Callable[..., Told]) -> None:
    for name in ("tiny.csv", "tiny.parquet"):
        assert tell("score", f"results/{name}") == (0, "2 of 2 cells agree with their traces\n", "")


@pytest.mark.parametrize("column", ["auc_all", "accuracy_low", "recall_at_5_metric"])
def test_a_forged_column_is_named(answered: ResultTable, tell: Callable[..., Told], column: str) -> None:
    rows = pd.read_csv(answered.csv)
    rows.loc[0, column] = 0.123456
    rows.to_csv(answered.csv, index=False)
    done = tell("score", "results/tiny.csv")
    assert done.code == 1
    first, last = done.out.splitlines()
    assert first == f"{rows['cell'].tolist()[0]}: the table differs from its trace in {column}"
    assert last == "1 of 2 cells agree with their traces"


def test_every_missing_or_damaged_trace_is_told(answered: ResultTable, tell: Callable[..., Told]) -> None:
    damaged, missing = traces(answered)
    damaged.write_bytes(damaged.read_bytes()[:100])
    missing.unlink()
    done = tell("score", "results/tiny.csv")
    assert done.code == 1
    assert f"{damaged}: not a readable trace" in done.out
    assert f"{missing} is missing; run the sweep again" in done.out
    assert "0 of 2 cells agree" in done.out


def test_a_trace_is_known_by_its_columns(answered: ResultTable, here: Path, tell: Callable[..., Told]) -> None:
    elsewhere = traces(answered)[0].rename(here / "mine.parquet")
    done = tell("score", elsewhere.name)
    assert done.code == 0
    scores = dict(line.split() for line in done.out.splitlines())
    row = pd.read_csv(answered.csv).iloc[0]
    assert {"auc", "recall_at_20_metric", "no_match", "accuracy_low"} <= scores.keys()
    for name, score in scores.items():
        assert float(score) == pytest.approx(row[name], abs=2e-6, nan_ok=True)


def test_what_is_neither_table_nor_trace_is_told(here: Path, tell: Callable[..., Told]) -> None:
    (here / "junk.parquet").write_bytes(b"junk")
    done = tell("score", "junk.parquet")
    assert done.code == 3
    assert "not readable as a result table or a trace" in done.err
    assert len(done.err.splitlines()) == 1


def test_checks_that_do_not_apply_are_not_called_ok(tell: Callable[..., Told]) -> None:
    done = tell("check", "thumbnail")
    assert done.code == 0
    lines = done.out.splitlines()
    assert "ok              clear-forgets" in lines
    reason = "it has no describe and compare, which are optional"
    assert [line for line in lines if "compare" in line] == [
        f"does not apply  {name}-agrees-with-compare: {reason}" for name in ("respond", "learn")
    ]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--video", "drive.avi"], "ends in .mp4"),
        (["--video", "nowhere/drive.mp4"], "there is no folder nowhere"),
        (["--trace", "trace.csv"], "ends in .parquet"),
        (["--trace", "nowhere/trace.parquet"], "there is no folder nowhere"),
    ],
)
def test_what_cannot_be_written_is_told_before_anything_runs(
    tell: Callable[..., Told], monkeypatch: pytest.MonkeyPatch, words: list[str], said: str
) -> None:
    monkeypatch.setattr("vprbench.cli.single.load_route", lambda *given: pytest.fail("it ran"))
    done = tell("run", "Street-Wide", "thumbnail", *words)
    assert done.code == 2
    assert said in done.err
    assert len(done.err.splitlines()) == 1


def test_a_film_without_its_extra_is_told_before_anything_runs(
    tell: Callable[..., Told], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vprbench.cli.single.load_route", lambda *given: pytest.fail("it ran"))
    monkeypatch.setattr("vprbench.cli.single.find_spec", lambda name: None)
    done = tell("run", "Street-Wide", "thumbnail", "--video", "drive.mp4")
    assert (done.code, done.err) == (2, "vprbench: --video needs moviepy: pip install 'vprbench[video]'\n")


def test_what_many_jobs_have_to_say_alike_is_told_once() -> None:
    sweep = [Job("Tiny", f"agent-{number}", 0, {"localizer": "thumbnail"}, ()) for number in range(3)]
    console = Console(width=120, file=io.StringIO())
    with SweepProgress(sweep, console) as progress:
        for number in range(3):
            progress.step(Progress(number, "fitted", 1, 1, "encoder not stored: the disk is full"))
            progress.step(Progress(number, "fitted", 1, 1))
    said = console.file.getvalue()  # type: ignore[attr-defined]
    assert said == "           Tiny/agent-0/s0: encoder not stored: the disk is full\n"
