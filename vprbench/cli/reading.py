"""`vprbench table` and `vprbench score`: reading what sweeps left."""

from __future__ import annotations

from collections.abc import Hashable
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from vprbench.errors import ConfigError, nearest
from vprbench.metrics import METRICS, evaluate
from vprbench.results import ResultTable, read_table
from vprbench.tables import make_table, to_csv, to_latex, to_markdown, to_terminal
from vprbench.trace import Trace

__all__ = ["score_command", "table_command"]

TEXT_FORMATS = {"markdown": to_markdown, "latex": to_latex, "csv": to_csv}

# The table rounds to six decimals.
SAME = 1e-6


def table_command(results: Path, rows: str, columns: str, metric: str, format: str) -> None:
    """Print a pivoted table."""
    if format not in {*TEXT_FORMATS, "terminal"}:
        raise ConfigError(f"--format {format!r}: {nearest(format, [*TEXT_FORMATS, 'terminal'])}")
    table = make_table(read_table(results), rows=rows, columns=columns, metric=metric)
    console = Console()
    if format == "terminal":
        console.print(to_terminal(table))
    else:
        console.out(TEXT_FORMATS[format](table), highlight=False, end="")


def score_command(results: Path) -> int:
    """Score traces again; 1 where a table says otherwise."""
    console = Console()
    if results.suffix == ".parquet" and results.parent.suffix == ".traces":
        for name, value in evaluate(Trace.load(results)).items():
            console.out(f"{name:32} {value:.6f}")
        return 0
    table = ResultTable(results.parent, results.stem)
    rows = read_table(results).to_dict("records")
    finished = [row for row in rows if row["status"] == "ok"]
    wrong = [row["cell"] for row in finished if not _agrees(table, row)]
    for cell in wrong:
        console.print(f"[red]{cell}: the table differs from its trace[/red]")
    console.print(f"{len(finished) - len(wrong)} of {len(finished)} cells agree with their traces", highlight=False)
    return 1 if wrong else 0


def _agrees(table: ResultTable, row: dict[Hashable, Any]) -> bool:
    """Whether a row holds the scores of its trace."""
    again = evaluate(table.trace(str(row["cell"])))
    return all(np.isclose(row[name], again[name], atol=SAME, rtol=0, equal_nan=True) for name in METRICS)
