"""`vprbench compare` on the committed tables: every format says the same, faults are told in one line."""

from __future__ import annotations

import io
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pandas as pd
import pytest

from vprbench.cli import main
from vprbench.paired import compare
from vprbench.results import ResultTable

RESULTS = Path(__file__).parents[2] / "results"


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def tell(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """Run `vprbench compare` in this process, on a narrow terminal."""
    monkeypatch.setenv("COLUMNS", "40")

    def run(*words: str) -> Told:
        monkeypatch.setattr(sys, "argv", ["vprbench", "compare", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run


@pytest.fixture(scope="module")
def two(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two agents of the committed table, whatever others it has."""
    folder = tmp_path_factory.mktemp("two")
    rows = pd.read_csv(RESULTS / "k0-2.csv", dtype=str, keep_default_na=False)
    rows[rows["agent"].isin(["CoHOG", "LPMP"])].to_csv(folder / "two.csv", index=False)
    shutil.copytree(RESULTS / "k0-2.traces", folder / "two.traces")
    return folder / "two.csv"


@pytest.fixture(scope="module")
def row(two: Path) -> pd.Series:
    """What there is to say."""
    return compare(ResultTable(two.parent, "two"), "accuracy_metric", reference="LPMP").iloc[0]


def test_csv_holds_the_exact_figures(tell: Callable[..., Told], two: Path, row: pd.Series) -> None:
    done = tell(str(two), "--metric", "accuracy_metric", "--reference", "LPMP", "--format", "csv")
    assert done.code == 0
    written = pd.read_csv(io.StringIO(done.out))
    assert written.columns.tolist() == row.index.tolist()
    assert written.iloc[0].tolist() == row.tolist()


@pytest.mark.parametrize("format", ["terminal", "markdown", "latex"])
def test_every_format_says_the_same(tell: Callable[..., Told], two: Path, row: pd.Series, format: str) -> None:
    done = tell(str(two), "--metric", "accuracy_metric", "--format", format)
    assert done.code == 0
    interval = f"{100 * row['low']:+.1f} to {100 * row['high']:+.1f}"
    for text in ("CoHOG", "LPMP", f"{100 * row['difference']:+.1f}", interval, "80", "1, 1", str(row["verdict"])):
        assert text in done.out
    assert "paired differences in percentage points" in " ".join(done.out.split())
    assert "by chance" in done.out


def test_markdown_and_latex_are_tables(tell: Callable[..., Told], two: Path) -> None:
    markdown = tell(str(two), "--format", "markdown").out.splitlines()
    rows = [line for line in markdown if line.startswith("|")]
    assert [line.count("|") for line in rows] == [9, 9, 9]
    latex = tell(str(two), "--format", "latex").out
    assert latex.count(r"& 95 \% interval &") == 1
    (body,) = [line for line in latex.splitlines() if "CoHOG" in line]
    assert body.count("&") == 7


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--metric", "acuracy"], "did you mean 'accuracy'"),
        (["--reference", "LPMM"], "did you mean 'LPMP'"),
        (["--format", "latx"], "did you mean 'latex'"),
    ],
)
def test_a_typo_is_told_in_one_line(tell: Callable[..., Told], two: Path, words: list[str], said: str) -> None:
    done = tell(str(two), *words)
    assert done.code == 2
    assert said in done.err
    assert len(done.err.splitlines()) == 1


def test_missing_tables_and_traces_are_told(tell: Callable[..., Told], two: Path, tmp_path: Path) -> None:
    assert "nowhere.csv" in tell(str(tmp_path / "nowhere.csv")).err
    shutil.copy(two, tmp_path)
    done = tell(str(tmp_path / "two.csv"))
    assert done.code == 3
    assert "not a readable trace" in done.err
    assert len(done.err.splitlines()) == 1
