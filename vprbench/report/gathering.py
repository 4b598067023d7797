"""Reading what a sweep left: what there is of it, and why the rest is not."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from vprbench.catalogue import catalogue, load_route
from vprbench.data_root import data_root
from vprbench.errors import ConfigError, DataError, VprbenchError
from vprbench.figures.panels import Run
from vprbench.provenance import data_checksum
from vprbench.report.material import Absence, Material, Question
from vprbench.results import ResultTable, read_table
from vprbench.route import Route
from vprbench.toml_files import parse_toml, toml_text

__all__ = ["read_material"]


def read_material(results: Path, data: Path | None = None, routes: Path | None = None) -> Material:
    """Gather what there is, and why the rest is not.

    Args:
        results: the CSV or Parquet of a sweep.
        data: the data root.
        routes: TOML file with routes of the user's own; else the one that the question names.

    Raises:
        ConfigError: the question, or a file or folder that was named, is wrong.
        DataError: the results are missing, damaged, or without a row.
    """
    data_root(data)
    rows = read_table(results)
    if rows.empty:
        raise DataError(f"{results}: no row to report; run the sweep first")
    table = ResultTable(results.parent, results.stem)
    question = _question(table.question)
    named = results.parent / str(question.says.get("routes_file", ""))
    own = routes or (named if named.is_file() else None)
    catalogue(own)
    runs, faults = _runs(table, rows)
    present, absent = _routes(rows, data, own)
    return Material(results.stem, rows, question, runs, faults, present, absent, _appendices(results))


def _question(path: Path) -> Question:
    """The TOML beside the results."""
    if not path.exists():
        return Question("", {})
    text = toml_text(path)
    return Question(text, parse_toml(text, str(path)))


def _runs(table: ResultTable, rows: pd.DataFrame) -> tuple[list[Run], dict[str, str]]:
    """Every run whose trace can be read, and why the others cannot."""
    runs, faults = [], {}
    for row in rows[rows["status"] == "ok"].to_dict("records"):
        cell = str(row["cell"])
        try:
            trace = table.trace(cell)
        except DataError:
            state = "damaged" if table.trace_path(cell).exists() else "missing"
            faults[cell] = f"{table.name}.traces/{cell}.parquet is {state}; measure the cell again"
            continue
        runs.append(
            Run(str(row["route"]), float(row["sampling_distance_m"]), str(row["agent"]), int(row["seed"]), trace)
        )
    return runs, faults


def _routes(rows: pd.DataFrame, data: Path | None, own: Path | None) -> tuple[dict[str, Route], dict[str, Absence]]:
    """The roads whose data are here, and why the others are not."""
    present, absent = dict[str, Route](), dict[str, Absence]()
    for name, group in rows.groupby("route", sort=False):
        measured = set(group["data_checksum"]) - {""}
        try:
            route = load_route(str(name), data, own)
        except VprbenchError as error:
            unknown = isinstance(error, ConfigError)
            why = "no route of this name is known here" if unknown else "its data are not here, or not whole"
            absent[str(name)] = Absence(why, str(error))
            continue
        if measured - {data_checksum(route)}:
            why = "its data here are not those that were measured"
            absent[str(name)] = Absence(why, f"{why}: their checksum differs")
        else:
            present[str(name)] = route
    return present, absent


def _appendices(results: Path) -> dict[str, pd.DataFrame]:
    """Tables beside the results whose names begin with theirs: NAME.fit.csv is "fit"."""
    found = {}
    for path in sorted(results.parent.glob("*.csv")):
        label = path.stem.removeprefix(f"{results.stem}.")
        if label not in (path.stem, "previous"):
            try:
                found[label] = pd.read_csv(path)
            except (OSError, ValueError) as error:
                raise DataError(f"{path}: not readable as a table: {error}") from error
    return found
