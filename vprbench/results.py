"""The result table of a sweep on disk: TOML, CSV, Parquet and traces, never half-written.

    <sweep>.toml           the question
    <sweep>.csv, .parquet  the answer, one tidy row a cell
    <sweep>.traces/        every answer of every cell, for scoring again without the localizer

Each finished cell is stored at once (trace first, then its row), every file by writing beside it and renaming, so
an interruption loses nothing that was finished.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from vprbench.atomic import replacing
from vprbench.errors import DataError
from vprbench.runner import Outcome
from vprbench.sweep import Cell
from vprbench.trace import Trace

__all__ = ["ResultTable", "read_table"]

# Enough digits to tell any two scores apart, few enough to read.
FLOAT_FORMAT = "%.6f"
SORT = ["route", "agent", "sampling_distance_m", "seed"]


@dataclass
class ResultTable:
    """The answers of one sweep, kept on disk as they come.

    Attributes:
        folder: where the files lie.
        name: of the sweep.
    """

    folder: Path
    name: str
    _rows: dict[str, dict[str, Any]] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        """Read what is already there."""
        if self.csv.exists():
            rows = read_table(self.csv).to_dict("records")
            self._rows = {str(row["cell"]): {str(key): value for key, value in row.items()} for row in rows}

    @property
    def csv(self) -> Path:
        """The table for people."""
        return self.folder / f"{self.name}.csv"

    def trace_path(self, cell: str) -> Path:
        """Where the trace of a cell lies."""
        return self.folder / f"{self.name}.traces" / (cell.replace("/", "_") + ".parquet")

    def row(self, cell: Cell) -> dict[str, Any] | None:
        """The finished row of a cell, None where it is missing or failed."""
        row = self._rows.get(cell.id)
        return row if row is not None and row["status"] == "ok" else None

    def frame(self) -> pd.DataFrame:
        """All rows as a table, sorted by route, agent, sampling distance and seed."""
        rows = pd.DataFrame(list(self._rows.values()))
        return rows.sort_values(SORT, ignore_index=True) if len(rows) else rows

    def begin(self, question: Path) -> None:
        """Make the folder, and lay the question beside the answer."""
        try:
            self.trace_path("").parent.mkdir(parents=True, exist_ok=True)
            with replacing(self.folder / f"{self.name}.toml") as path:
                shutil.copyfile(question, path)
        except OSError as error:
            raise DataError(f"cannot write results: {error}; choose another folder with --out") from error

    def add(self, outcome: Outcome) -> None:
        """Store the outcome of a cell: its trace, then its row."""
        if outcome.trace is not None:
            outcome.trace.save(self.trace_path(outcome.cell.id))
        self._rows[outcome.cell.id] = outcome.row
        self._save()

    def forget(self) -> None:
        """Drop every row, for a sweep that starts over."""
        self._rows.clear()

    def _save(self) -> None:
        """Write the CSV and the Parquet."""
        table = self.frame()
        with replacing(self.csv) as path:
            table.to_csv(path, index=False, float_format=FLOAT_FORMAT, lineterminator="\n")
        # The Parquet holds exactly what the CSV says, so that neither can contradict the other.
        with replacing(self.csv.with_suffix(".parquet")) as path:
            read_table(self.csv).to_parquet(path, index=False)

    def trace(self, cell: str) -> Trace:
        """The trace of a finished cell."""
        return Trace.load(self.trace_path(cell))


def read_table(path: Path) -> pd.DataFrame:
    """A result table from its CSV or Parquet.

    Raises:
        DataError: the file is missing, damaged or no result table.
    """
    try:
        table = pd.read_parquet(path) if path.suffix == ".parquet" else _read_csv(path)
    except (OSError, ValueError) as error:
        raise DataError(f"{path}: not readable as a result table: {error}") from error
    missing = {"cell", "status", "agent_config", *SORT} - set(table.columns)
    if missing:
        raise DataError(f"{path}: no result table: it has no column {', '.join(sorted(missing))}")
    return table


def _read_csv(path: Path) -> pd.DataFrame:
    """The CSV, with text columns that may be empty kept as text."""
    text = dict.fromkeys(["cell", "route", "agent", "status", "error", "commit", "vprbench", "python"], str)
    table = pd.read_csv(path, dtype=text)
    return table.fillna(dict.fromkeys(text.keys() & set(table.columns), ""))
