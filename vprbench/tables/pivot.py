"""One metric of many cells as a table: agents against routes, environments or sampling distances.

An entry of the table stands for one cell of a sweep or for several. Of several it shows the mean, in which each
configuration (route and sampling distance) counts once however many seeds it was run with, and the standard
deviation (ddof = 1) over the configurations or, where there is but one, over its seeds. That is how much the score
spreads, not how unsure the mean is. Only an entry of a single cell shows its bootstrap interval: cells share frames
and dictionaries, so their intervals cannot be joined into an interval of the mean.
"""

from __future__ import annotations

from dataclasses import replace

import pandas as pd

from vprbench.columns import length_unit
from vprbench.errors import ConfigError, DataError, nearest
from vprbench.metrics import METRICS
from vprbench.tables.model import NAN, Entry, Table, unit

__all__ = ["AXES", "make_table"]

AXES = ("agent", "route", "environment", "sampling_distance_m")

CONFIGURATION = ["route", "sampling_distance_m"]
NEEDED = ("cell", "status", "agent", "seed", *CONFIGURATION)
LOWER_IS_BETTER = ("error_mean_m", "error_median_m", "no_match")


def make_table(
    results: pd.DataFrame, *, rows: str = "agent", columns: str = "sampling_distance_m", metric: str = "auc"
) -> Table:
    """Pivot tidy results, one row a cell, into a table of one metric.

    The mean over the axis that is not the agents' stands at its end: the mean and standard deviation of the
    entries before it. Entries that are best to the decimals shown are best together.

    Args:
        results: one row a cell: cell, status ("ok" or else failed), agent, seed, route, sampling_distance_m,
            perhaps environment, and the metrics of `evaluate` and `intervals`.
        rows: one of `AXES`.
        columns: another one.
        metric: the column to show, one of `METRICS` or any other number.

    Raises:
        ConfigError: no such column, the same axis twice, or different agents would be averaged.
        DataError: the results lack a needed column, or hold a cell twice.
    """
    _check_results(results)
    _check_request(results, rows, columns, metric)
    if columns == "agent":
        return make_table(results, rows=columns, columns=rows, metric=metric).transposed()
    return _pivot(_tidy(results, rows, columns, metric), rows, columns, metric, length_unit(results))


def _pivot(cells: pd.DataFrame, rows: str, columns: str, metric: str, length: str) -> Table:
    """The table of tidy cells."""
    grid, heads = _grid(cells, rows, columns), [_head(columns, key, length) for key in _keys(cells[columns])]
    if len(heads) > 1:
        heads.append("mean")
        grid = [[*line, _mean(line)] for line in grid]
    crowned = [_crown(column, metric) if rows == "agent" else column for column in zip(*grid, strict=True)]
    return Table(
        metric=metric,
        axes=(rows, columns),
        rows=tuple(_head(rows, key, length) for key in _keys(cells[rows])),
        columns=tuple(heads),
        entries=tuple(zip(*crowned, strict=True)),
        cells=len(cells),
        failed=tuple(cells["cell"][cells["status"] != "ok"]),
        length=length,
    )


def _grid(cells: pd.DataFrame, rows: str, columns: str) -> list[list[Entry]]:
    """The entries, line by line; one without cells where nothing was run."""
    known = {key: _entry(group) for key, group in cells.groupby([rows, columns])}
    return [[known.get((row, column), Entry()) for column in _keys(cells[columns])] for row in _keys(cells[rows])]


def _check_results(results: pd.DataFrame) -> None:
    """Refuse what is not one row a cell."""
    if missing := [name for name in NEEDED if name not in results]:
        raise DataError(f"table: the results have no column {missing[0]!r}; give a result table of `vprbench sweep`")
    if results.empty:
        raise DataError("table: the results have no rows; run the sweep first")
    if (twice := results["cell"].duplicated()).any():
        raise DataError(f"table: cell {results['cell'][twice].iloc[0]} stands twice in the results; drop one")


def _check_request(results: pd.DataFrame, rows: str, columns: str, metric: str) -> None:
    """Refuse axes and metrics that the results do not have, and a mean over agents."""
    axes = [axis for axis in AXES if axis in results]
    for axis in (rows, columns):
        if axis not in axes:
            raise ConfigError(f"table: no axis {axis!r}: {nearest(axis, axes)}")
    if rows == columns:
        raise ConfigError(f"table: rows and columns are both {rows!r}; choose two of {', '.join(axes)}")
    if "agent" not in (rows, columns) and results["agent"].nunique() > 1:
        raise ConfigError("table: it would average different agents; put 'agent' on an axis, or choose one agent")
    if metric not in (allowed := _metrics(results)):
        raise ConfigError(f"table: no metric {metric!r}: {nearest(metric, allowed)}")


def _metrics(results: pd.DataFrame) -> set[str]:
    """The columns that can be tabled: every metric, and whatever else is a number."""
    numbers = set(results.select_dtypes("number").columns) - {"seed", *AXES}
    return {*METRICS, *(name for name in numbers if not name.endswith(("_low", "_high")))}


def _tidy(results: pd.DataFrame, rows: str, columns: str, metric: str) -> pd.DataFrame:
    """The cells with what an entry needs: value and interval, NaN where the cell failed, and its configuration."""
    cells = results[[name for name in (*NEEDED, "environment") if name in results]].copy()
    if "environment" in cells:
        # A failed cell knows its route but not the route's environment: another cell of the route does.
        cells["environment"] = cells.groupby("route")["environment"].transform("first").astype(object).fillna("")
    measured = results.reindex(columns=[metric, f"{metric}_low", f"{metric}_high"]).where(results["status"] == "ok")
    cells[["value", "low", "high"]] = measured.astype(float)
    cells["configuration"] = cells.groupby(CONFIGURATION).ngroup()
    peers = [axis for axis in (rows, columns) if axis != "agent"]
    cells["wanted"] = cells.groupby(peers)["configuration"].transform("nunique")
    return cells


def _keys(axis: pd.Series) -> list[str] | list[float]:
    """What stands along an axis: numbers in order, names as they first come."""
    keys = axis.unique().tolist()
    return sorted(map(float, keys)) if pd.api.types.is_numeric_dtype(axis) else keys


def _head(axis: str, key: str | float, length: str) -> str:
    return f"{key:g} {length}" if axis == "sampling_distance_m" else str(key)


def _entry(group: pd.DataFrame) -> Entry:
    """The entry of the cells that share a row and a column."""
    known = group.dropna(subset="value")
    configurations = known.groupby("configuration")["value"].mean()
    spread = configurations if len(configurations) > 1 else known["value"]
    single = len(known) == 1
    return Entry(
        mean=float(configurations.mean()),
        sd=float(spread.std(ddof=1)),
        low=float(known["low"].iloc[0]) if single else NAN,
        high=float(known["high"].iloc[0]) if single else NAN,
        cells=len(known),
        partial=len(known) < len(group) or len(configurations) < int(group["wanted"].iloc[0]),
    )


def _mean(entries: list[Entry]) -> Entry:
    """The mean of a row's entries, each counting once."""
    means = pd.Series([entry.mean for entry in entries], dtype=float).dropna()
    return Entry(
        mean=float(means.mean()),
        sd=float(means.std(ddof=1)),
        cells=sum(entry.cells for entry in entries),
        partial=any(entry.partial for entry in entries),
    )


def _crown(column: tuple[Entry, ...], metric: str) -> tuple[Entry, ...]:
    """The same entries, the best of several marked."""
    shown = [round(entry.mean * unit(metric).factor, unit(metric).decimals) for entry in column]
    rivals = [score for score, entry in zip(shown, column, strict=True) if not entry.partial]
    if metric not in METRICS or len(rivals) < 2:
        return column
    best = min(rivals) if metric in LOWER_IS_BETTER else max(rivals)
    return tuple(
        replace(entry, best=score == best and not entry.partial) for score, entry in zip(shown, column, strict=True)
    )
