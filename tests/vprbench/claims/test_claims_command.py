"""`vprbench claims` in each of its formats."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from vprbench.claims import RULES, evaluate, load_claims
from vprbench.claims.formats import to_latex, to_markdown
from vprbench.cli import main


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two agents' frequencies, and nothing else."""
    folder = tmp_path_factory.mktemp("runs")
    rows = ["agent,places,query_ms,query_ms_q1,query_ms_q3", "HSD-18,150,5.0,4.5,5.5", "LPMP,150,10.0,9.0,11.0"]
    (folder / "frequency.csv").write_text("\n".join(rows))
    return folder


@pytest.fixture(scope="module")
def table(folder: Path) -> pd.DataFrame:
    """The claims judged by that."""
    return evaluate(folder, data=folder)


@pytest.fixture
def tell(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, str, str]]:
    """Run the command in this process: exit code and what it said."""
    monkeypatch.setenv("COLUMNS", "200")

    def run(*words: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["vprbench", "claims", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        return int(ended.value.code or 0), *capsys.readouterr()

    return run


COUNTS = "60 claims: 2 supported, 0 not supported, 58 not testable on the data present."


def plain(text: str) -> str:
    """Without escapes and line breaks."""
    return " ".join(text.replace("\\", "").split())


def test_the_terminal_counts_the_verdicts_and_states_the_rules(
    folder: Path, tell: Callable[..., tuple[int, str, str]]
) -> None:
    code, out, _ = tell(str(folder), "--data", str(folder))
    assert code == 0
    assert COUNTS in plain(out)
    assert all(rule in plain(out) for rule in RULES)


def test_markdown(table: pd.DataFrame) -> None:
    text = to_markdown(table)
    lines = text.splitlines()
    assert lines[0] == "| claim | paper | ours | interval | unit | verdict | measured on | note |"
    assert (
        "| HSD-18, as accurate as LPMP, has twice its frequency with 150 places "
        "\\[configurations; figure of frequency\\] | 2 | 2 | 1.636 to 2.444 | x | supported "
        "| frequency.csv, 150 places | 200.0 Hz and 100.0 Hz; see places-150, speed-chain |"
    ) in lines
    assert COUNTS in text
    assert all(f"- {rule}" in lines for rule in RULES)
    for entry in load_claims().disclosures:
        assert any(line.startswith(f"- **{entry.id}**: ") for line in lines)


def test_latex(table: pd.DataFrame) -> None:
    text = to_latex(table)
    assert text.startswith("\\begin{longtable}")
    assert "an 80 \\% higher frequency" in text
    assert COUNTS in text


def test_csv_is_the_table(folder: Path, table: pd.DataFrame, tell: Callable[..., tuple[int, str, str]]) -> None:
    code, out, _ = tell(str(folder), "--data", str(folder), "--format", "csv")
    assert code == 0
    read = pd.read_csv(io.StringIO(out)).fillna({"measured_on": "", "note": ""})
    pd.testing.assert_frame_equal(read, table, check_dtype=False)


def test_an_unknown_format_is_refused(folder: Path, tell: Callable[..., tuple[int, str, str]]) -> None:
    code, _, err = tell(str(folder), "--format", "html")
    assert code == 2
    assert "--format 'html'" in err
