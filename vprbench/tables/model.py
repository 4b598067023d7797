"""What a table is before it is written in any format: entries, heads, units."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

from vprbench.metrics import METRICS

__all__ = ["NAN", "Entry", "Table", "Unit", "unit"]

NAN = float("nan")


class Unit(NamedTuple):
    """How a column of the results is shown: multiplied by a factor, with so many decimals."""

    factor: float
    decimals: int
    symbol: str


def unit(metric: str, length: str = "m") -> Unit:
    """The unit of a column of the results: that of lengths, per cent for the other metrics, else as it is."""
    if metric.endswith("_m"):
        return Unit(1.0, 2, length)
    return Unit(100.0, 1, "%") if metric in METRICS else Unit(1.0, 3, "")


@dataclass(frozen=True)
class Entry:
    """One entry of a table, in the units of the results.

    Attributes:
        mean: of the metric; NaN where no cell has a value.
        sd: standard deviation over configurations, else over seeds; NaN for a single cell.
        low: lower end of the interval of a single cell, else NaN.
        high: upper end of it.
        cells: how many cells have a value.
        partial: whether a cell failed or has no value, or another agent was run with more configurations: then
            the mean is over other things than its neighbours are.
        best: whether no other agent is shown with a better score here; only among entries that are not partial.
    """

    mean: float = NAN
    sd: float = NAN
    low: float = NAN
    high: float = NAN
    cells: int = 0
    partial: bool = True
    best: bool = False


@dataclass(frozen=True)
class Table:
    """A table before it is written in any format.

    Attributes:
        metric: the column of the results that is shown.
        axes: the columns of the results along its rows and along its columns.
        rows: heads of the rows; the last may be the mean.
        columns: heads of the columns; the last may be the mean.
        entries: one tuple a row.
        cells: how many cells were asked for.
        failed: ids of those that failed.
        length: what distances and errors are in: metres, frames, or either.
    """

    metric: str
    axes: tuple[str, str]
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    entries: tuple[tuple[Entry, ...], ...]
    cells: int
    failed: tuple[str, ...]
    length: str = "m"

    def transposed(self) -> Table:
        """The same table with rows and columns exchanged."""
        turned = tuple(zip(*self.entries, strict=True))
        return replace(self, axes=self.axes[::-1], rows=self.columns, columns=self.rows, entries=turned)
