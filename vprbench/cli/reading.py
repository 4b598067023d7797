"""`vprbench table` and `vprbench score`: reading what sweeps left."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from rich.console import Console
from rich.markup import escape

from vprbench.bootstrap import intervals
from vprbench.errors import ConfigError, DataError, nearest
from vprbench.metrics import evaluate
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
        console.print(to_terminal(table), soft_wrap=True)
    else:
        console.out(TEXT_FORMATS[format](table), highlight=False, end="")


def score_command(results: Path) -> int:
    """Score traces again; 1 where a table says otherwise, or where a trace cannot be read."""
    console = Console()
    if _is_trace(results):
        for name, value in _scores(Trace.load(results)).items():
            console.out(f"{name:32} {value:.6f}")
        return 0
    table = ResultTable(results.parent, results.stem)
    finished = [row for row in read_table(results).to_dict("records") if row["status"] == "ok"]
    faults = {str(row["cell"]): fault for row in finished if (fault := _fault(table, row))}
    for cell, fault in faults.items():
        console.print(f"[red]{escape(f'{cell}: {fault}')}[/red]", highlight=False, soft_wrap=True)
    console.print(f"{len(finished) - len(faults)} of {len(finished)} cells agree with their traces", highlight=False)
    return 1 if faults else 0


def _is_trace(path: Path) -> bool:
    """Whether a file holds a trace rather than a result table, by its columns."""
    if path.suffix != ".parquet":
        return False
    try:
        return "hypothesis" in pq.read_schema(path).names
    except (OSError, pa.ArrowException) as error:
        raise DataError(f"{path}: not readable as a result table or a trace: {error}") from error


def _scores(trace: Trace) -> dict[str, float]:
    """Every number of a row that its trace decides: the metrics and their intervals."""
    return evaluate(trace) | intervals(trace)


def _fault(table: ResultTable, row: Mapping[Hashable, object]) -> str | None:
    """What keeps a row from being confirmed by its trace: the trace is not there, or says otherwise."""
    cell = str(row["cell"])
    path = table.trace_path(cell)
    if not path.exists():
        return f"its trace {path} is missing; run the sweep again"
    try:
        again = _scores(table.trace(cell))
    except DataError as error:
        return str(error)
    differ = [name for name, score in again.items() if not _same(row.get(name), score)]
    return f"the table differs from its trace in {', '.join(differ)}" if differ else None


def _same(stored: object, score: float) -> bool:
    """Whether a table holds a score, to the decimals that it keeps."""
    return isinstance(stored, float | int) and bool(np.isclose(stored, score, atol=SAME, rtol=0, equal_nan=True))
