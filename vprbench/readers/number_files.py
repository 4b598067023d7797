"""Text files of numbers, read strictly: every line has its columns, every value is finite and of a size that can be."""

from __future__ import annotations

from codecs import BOM_UTF8
from collections.abc import Callable
from pathlib import Path

import numpy as np
from jaxtyping import Float64

from vprbench.errors import DataError

__all__ = ["LARGEST", "check_increasing", "not_fit", "read_numbers", "read_text"]

# Nothing that a drive is described by is larger: nanoseconds since 1970 are 2e18. Beyond, squares overflow. Our choice.
LARGEST = 1e20

# Seconds from 1970 to 2286: larger times are not seconds. Our choice.
_LATEST = 1e10


def read_text(path: Path) -> str:
    """The text of a file in UTF-8, with or without its mark; DataError names the first line that is something else."""
    try:
        data = path.read_bytes().removeprefix(BOM_UTF8)
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror})") from error
    try:
        text = data.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise DataError(f"{path}, line {line}: not UTF-8; save the file as text in UTF-8") from error
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise DataError(f"{path}, line {line}: holds a NUL, which no text does; save the file as text in UTF-8")
    return text


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
    bad = np.argwhere(~(np.abs(values) <= LARGEST))
    if bad.size:
        line, column = bad[0]
        raise DataError(f"{path}, line {line + 1}: {rows[line][column]!r} is {not_fit(values[line, column])}")
    return values


def not_fit(value: float) -> str:
    """What a value is that is NaN, infinite or larger than `LARGEST`, for messages."""
    return "too large a number" if np.isfinite(value) else "not a finite number"


def check_increasing(times: Float64[np.ndarray, " n"], where: Callable[[int], str]) -> None:
    """Refuse times, seconds, that stand still, run backwards or are none; `where` names the file and line of row i."""
    bad = np.flatnonzero(np.diff(times) <= 0)
    if bad.size:
        raise DataError(f"{where(int(bad[0]) + 1)}: the time is not after the one before")
    odd = np.flatnonzero(~((times >= 0) & (times <= _LATEST)))
    if odd.size:
        raise DataError(f"{where(int(odd[0]))}: the time {times[odd[0]]:g} is not within 0 to {_LATEST:g} s")


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return float("nan")
