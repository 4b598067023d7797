"""A CSV file read strictly: known columns, complete lines, finite numbers, and every fault by its line."""

from __future__ import annotations

import csv
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

import numpy as np
from jaxtyping import Float64

from vprbench.errors import DataError, nearest
from vprbench.readers.number_files import LARGEST, not_fit, read_text

__all__ = ["CsvTable", "check_widths", "read_csv", "read_rows"]


@dataclass(frozen=True)
class CsvTable:
    """The words of a CSV file.

    Attributes:
        path: the file.
        columns: the words of each column, by its name.
        lines: the line of each row in the file, from 1.
    """

    path: Path
    columns: Mapping[str, tuple[str, ...]]
    lines: tuple[int, ...]

    def where(self, row: int) -> str:
        """The file and line of a row, for messages."""
        return f"{self.path}, line {self.lines[row]}"

    def part(self, first: int, last: int) -> CsvTable:
        """The rows from one to another, both counted from 0 and included; DataError where there are fewer."""
        if last >= len(self.lines):
            raise DataError(f"{self.path}: {len(self.lines)} rows, too few for frame {last}")
        rows = slice(first, last + 1)
        return CsvTable(self.path, {name: words[rows] for name, words in self.columns.items()}, self.lines[rows])

    def numbers(self, name: str) -> Float64[np.ndarray, " rows"]:
        """A column as finite numbers; DataError names the first that is none."""
        return np.array([self._number(name, row) for row in range(len(self.lines))])

    def _number(self, name: str, row: int) -> float:
        word = self.columns[name][row]
        try:
            value = float(word)
        except ValueError:
            value = np.nan
        if not abs(value) <= LARGEST:
            hint = "; write decimals with a point" if "," in word else ""
            raise DataError(f"{self.where(row)}: {name} is {word!r}, {not_fit(value)}{hint}")
        return value


def read_csv(path: Path, known: Collection[str]) -> CsvTable:
    """Read a CSV file whose header names known columns only; blank lines are passed over.

    Raises:
        DataError: a file that cannot be read, an unknown or repeated column, or a line with more or fewer words.
    """
    rows = [(line, [word.strip() for word in words]) for line, words in read_rows(path)]
    (_, header), *body = rows
    _check_header(path, header, known)
    check_widths(path, rows)
    columns = {name: tuple(words[i] for _, words in body) for i, name in enumerate(header)}
    return CsvTable(path, columns, tuple(line for line, _ in body))


def read_rows(path: Path) -> list[tuple[int, list[str]]]:
    """The words of a CSV file, header first, each row with its line in the file; blank lines are passed over.

    Raises:
        DataError: a file that cannot be read, holds nothing, or ends within quotes.
    """
    reader = csv.reader(StringIO(read_text(path), newline=""), strict=True)
    try:
        rows = [(reader.line_num, words) for words in reader if words]
    except csv.Error as error:
        raise DataError(f"{path}, line {reader.line_num}: {error}") from error
    if not rows:
        raise DataError(f"{path}: the file is empty")
    return rows


def check_widths(path: Path, rows: Sequence[tuple[int, list[str]]]) -> None:
    """Refuse a line that has more or fewer words than the header, the first row."""
    columns = len(rows[0][1])
    for line, words in rows:
        if len(words) != columns:
            hint = "; write decimals with a point" if len(words) > columns else ""
            raise DataError(f"{path}, line {line}: {len(words)} values for {columns} columns{hint}")


def _check_header(path: Path, header: list[str], known: Collection[str]) -> None:
    unknown = [name for name in header if name not in known]
    for sign, name in ((";", "semicolons"), ("\t", "tabs")):
        if unknown and sign in unknown[0]:
            raise DataError(f"{path}, line 1: separated by {name}; separate the columns by commas")
    if unknown:
        raise DataError(f"{path}, line 1: unknown column {unknown[0]!r}: {nearest(unknown[0], known)}")
    if len(set(header)) < len(header):
        raise DataError(f"{path}, line 1: a column is named twice")
