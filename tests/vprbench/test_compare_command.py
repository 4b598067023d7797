"""`vprbench compare` on the committed tables: every format says the same, and faults are told in one line."""

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
def pairs() -> pd.DataFrame:
    return compare(ResultTable(RESULTS, "k0-2"), "accuracy_metric", reference="LPMP")


def test_csv_holds_the_exact_figures(tell: Callable[..., Told], pairs: pd.DataFrame) -> None:
    done = tell(str(RESULTS / "k0-2.csv"), "--metric", "accuracy_metric", "--reference", "LPMP", "--format", "csv")
    assert done.code == 0
    pd.testing.assert_frame_equal(pd.read_csv(io.StringIO(done.out)), pairs, check_dtype=False)


@pytest.mark.parametrize("format", ["terminal", "markdown", "latex"])
def test_every_format_says_the_same(tell: Callable[..., Told], pairs: pd.DataFrame, format: str) -> None:
    done = tell(str(RESULTS / "k0-2.csv"), "--metric", "accuracy_metric", "--format", format)
    assert done.code == 0
    (row,) = pairs.to_dict("records")
    interval = f"{100 * row['low']:+.1f} to {100 * row['high']:+.1f}"
    for text in ("CoHOG", "LPMP", f"{100 * row['difference']:+.1f}", interval, "80", "1, 1", "better"):
        assert text in done.out
    assert "paired differences in percentage points" in " ".join(done.out.split())
    assert "by chance" in done.out


def test_markdown_and_latex_are_tables(tell: Callable[..., Told]) -> None:
    markdown = tell(str(RESULTS / "streets.csv"), "--format", "markdown").out.splitlines()
    rows = [line for line in markdown if line.startswith("|")]
    assert len({line.count("|") for line in rows}) == 1
    latex = tell(str(RESULTS / "streets.csv"), "--format", "latex").out
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
def test_a_typo_is_told_in_one_line(tell: Callable[..., Told], words: list[str], said: str) -> None:
    done = tell(str(RESULTS / "k0-2.csv"), *words)
    assert done.code == 2
    assert said in done.err
    assert len(done.err.splitlines()) == 1


def test_missing_tables_and_traces_are_told(tell: Callable[..., Told], tmp_path: Path) -> None:
    assert "nowhere.csv" in tell(str(tmp_path / "nowhere.csv")).err
    shutil.copy(RESULTS / "k0-2.csv", tmp_path)
    done = tell(str(tmp_path / "k0-2.csv"))
    assert done.code == 3
    assert "not a readable trace" in done.err
    assert len(done.err.splitlines()) == 1
