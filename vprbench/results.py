"""The result table of a sweep on disk: TOML, CSV, Parquet and traces, never half-written.

    <sweep>.toml           the question
    <sweep>.csv, .parquet  the answer, one tidy row a cell
    <sweep>.traces/        every answer of every cell, for scoring again without the localizer

Each finished cell is stored at once (trace first, then its row), every file by writing beside it and renaming, so
an interruption loses nothing that was finished.
"""

from __future__ import annotations

import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from filelock import FileLock, Timeout

from vprbench.atomic import replacing
from vprbench.columns import COLUMNS, IMPLIED, typed
from vprbench.errors import ConfigError, DataError
from vprbench.readers.csv_table import check_widths, read_rows
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

    @property
    def question(self) -> Path:
        """The TOML of the sweep."""
        return self.folder / f"{self.name}.toml"

    def trace_path(self, cell: str) -> Path:
        """Where the trace of a cell lies: in folders as its id says."""
        return self.folder / f"{self.name}.traces" / f"{cell}.parquet"

    def trace(self, cell: str) -> Trace:
        """The trace of a finished cell."""
        return Trace.load(self.trace_path(cell))

    def row(self, cell: Cell) -> dict[str, Any] | None:
        """The finished row of a cell; None where it is missing, failed, or has lost its trace."""
        row = self._rows.get(cell.id)
        finished = row is not None and row["status"] == "ok" and self.trace_path(cell.id).exists()
        return row if finished else None

    def strangers(self, cells: Collection[Cell]) -> list[str]:
        """Rows of cells that the sweep does not ask for any more."""
        asked = {cell.id for cell in cells}
        return [cell for cell in self._rows if cell not in asked]

    def frame(self) -> pd.DataFrame:
        """All rows as a table, sorted by route, agent, sampling distance and seed."""
        return typed(pd.DataFrame(list(self._rows.values()))).sort_values(SORT, ignore_index=True)

    @contextmanager
    def writing(self, question: Path, cells: Collection[Cell], routes_file: Path | None = None) -> Iterator[None]:
        """While entered, this process alone writes here; the question is laid beside its answer.

        Rows that answer no cell of the question move, with the whole table, to NAME.previous.csv.

        Args:
            question: the TOML of the sweep.
            cells: all that it asks for.
            routes_file: which the question names, relative to it; laid beside the copy, which so still finds it.

        Raises:
            ConfigError: another process is writing, or the TOML there is not an earlier question of this table.
            DataError: the folder cannot be written.
        """
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with FileLock(self.folder / f".{self.name}.lock", timeout=0):
                self._ask(question, cells)
                self._lay_routes(question.parent, routes_file)
                yield
        except Timeout as error:
            raise ConfigError(f"another sweep is writing {self.csv}: wait for it, or choose another --out") from error
        except OSError as error:
            raise DataError(f"cannot write results: {error}; choose another folder with --out") from error

    def add(self, outcome: Outcome) -> None:
        """Store the outcome of a cell: its trace, then its row. A failure replaces no answer to the same question."""
        earlier = self.row(outcome.cell)
        if outcome.trace is not None:
            outcome.trace.save(self.trace_path(outcome.cell.id))
        elif earlier is not None and earlier["agent_config"] == outcome.row["agent_config"]:
            return
        self._rows[outcome.cell.id] = outcome.row
        self._save()

    def _ask(self, question: Path, cells: Collection[Cell]) -> None:
        """Lay down the question, and set aside the rows that do not answer it."""
        text = question.read_bytes()
        if self.question.exists() and not self.csv.exists() and self.question.read_bytes() != text:
            raise ConfigError(f"{self.question} is another question without an answer: choose another --out")
        if strangers := self.strangers(cells):
            shutil.copyfile(self.csv, self.folder / f"{self.name}.previous.csv")
            for cell in strangers:
                del self._rows[cell]
            self._save()
        with replacing(self.question) as path:
            path.write_bytes(text)

    def _lay_routes(self, source: Path, routes_file: Path | None) -> None:
        """Copy a routes file to where the question beside the answer looks for it, unless that is outside."""
        if routes_file is None or routes_file.is_absolute() or ".." in routes_file.parts:
            return
        text, copy = (source / routes_file).read_bytes(), self.folder / routes_file
        copy.parent.mkdir(parents=True, exist_ok=True)
        with replacing(copy) as path:
            path.write_bytes(text)

    def _save(self) -> None:
        """Write the CSV and the Parquet."""
        table = self.frame()
        with replacing(self.csv) as path:
            table.to_csv(path, index=False, float_format=FLOAT_FORMAT, lineterminator="\n")
        # The Parquet holds exactly what the CSV says, so that neither can contradict the other.
        with replacing(self.csv.with_suffix(".parquet")) as path:
            read_table(self.csv).to_parquet(path, index=False)


def read_table(path: Path) -> pd.DataFrame:
    """A result table from its CSV or Parquet.

    Raises:
        DataError: the file is missing, damaged or no result table.
    """
    if not path.exists():
        raise DataError(f"{path}: not readable as a result table: there is no such file; run its sweep first")
    try:
        table = pd.read_parquet(path) if path.suffix == ".parquet" else _read_csv(path)
        missing = [name for name in COLUMNS if name not in table.columns and name not in IMPLIED]
        if missing:
            raise ValueError(f"it has no column {missing[0]!r} (an older version's table is measured anew elsewhere)")
        rows = typed(table)
        _check_identity(rows)
        return rows
    except (OSError, ValueError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or error
        raise DataError(f"{path}: not readable as a result table: {reason}") from error


def _read_csv(path: Path) -> pd.DataFrame:
    """The CSV as text: nothing in it is taken for a number or for nothing by how it looks."""
    rows = read_rows(path)
    check_widths(path, rows)
    (_, header), *body = rows
    return pd.DataFrame([words for _, words in body], columns=header, dtype=str)


def _check_identity(rows: pd.DataFrame) -> None:
    """Refuse a row whose cell is not of its own route, agent and seed: damaged, or edited by hand."""
    named = rows[["cell", "route", "agent", "seed", "sampling_distance_m"]].itertuples(index=False)
    for number, (cell, route, agent, seed, distance) in enumerate(named, 1):
        start, _, *end = [*cell.split("/", 2), "", ""][:3]
        if start != route or end != [f"{agent}/s{seed}"] or not distance > 0:
            raise ValueError(f"row {number}: cell {cell!r} is not of its route, distance, agent and seed")
