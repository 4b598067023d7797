"""Text files of numbers, read strictly: every line has its columns, every value is finite."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from jaxtyping import Float64

from vprbench.errors import DataError

__all__ = ["check_increasing", "read_numbers", "read_text"]


def read_text(path: Path) -> str:
    """The text of a file; bytes that are no text come out as signs that no number has."""
    try:
        return path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror})") from error


def read_numbers(path: Path, columns: int) -> Float64[np.ndarray, "lines columns"]:
    """The numbers of a file with one row a line, separated by spaces; DataError names the first bad line."""
    rows = [line.split() for line in read_text(path).splitlines()]
    for line, row in enumerate(rows, 1):
        if len(row) != columns:
            raise DataError(f"{path}, line {line}: {len(row)} numbers where {columns} are due")
    if not rows:
        raise DataError(f"{path}: the file is empty")
    try:
        values = np.array(rows, np.float64)
    except ValueError:
        values = np.array([[_number(word) for word in row] for row in rows])
    bad = np.argwhere(~np.isfinite(values))
    if bad.size:
        line, column = bad[0]
        raise DataError(f"{path}, line {line + 1}: {rows[line][column]!r} is not a finite number")
    return values


def check_increasing(times: Float64[np.ndarray, " n"], where: Callable[[int], str]) -> None:
    """Refuse times that stand still or run backwards; `where` names the file and line of row i."""
    bad = np.flatnonzero(np.diff(times) <= 0)
    if bad.size:
        raise DataError(f"{where(int(bad[0]) + 1)}: the time is not after the one before")


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return float("nan")
