"""The columns of a result table, in their order, and the type of each: so that a failed row changes nothing else."""

from __future__ import annotations

import pandas as pd

from vprbench.bootstrap import INTERVAL_METRICS
from vprbench.metrics import METRICS
from vprbench.readers.number_files import LARGEST

__all__ = ["COLUMNS", "IMPLIED", "length_unit", "typed"]

_INTERVALS = [f"{name}{rule}_{end}" for rule in ("", "_metric") for name in INTERVAL_METRICS for end in ("low", "high")]

# Each column's type: text, whole numbers, or real numbers.
COLUMNS: dict[str, str] = {
    "cell": "str",
    "route": "str",
    "sampling_distance_m": "float64",
    "agent": "str",
    "seed": "Int64",
    "status": "str",
    "error": "str",
    "environment": "str",
    "split": "str",
    "unit": "str",
    "heading_source": "str",
    "sampling": "float64",
    "places": "Int64",
    "place_spacing_m": "float64",
    "learn_frames": "Int64",
    "queries": "Int64",
    "tolerance_mean_m": "float64",
    **dict.fromkeys(METRICS, "float64"),
    **dict.fromkeys(_INTERVALS, "float64"),
    "agent_config": "str",
    "tolerance_rule": "str",
    "recall_denominator": "str",
    "interval_rule": "str",
    "data_checksum": "str",
    "plugins": "str",
    "vprbench": "str",
    "commit": "str",
    "python": "str",
    "libraries": "str",
}

# Columns that a table may lack, and what it then says: before there were others, every distance was in metres.
IMPLIED = {"unit": "m", "heading_source": ""}


def length_unit(table: pd.DataFrame) -> str:
    """What the lengths in a table are in: "m", "frames", or "m or frames"; a cell that failed does not say."""
    units = sorted(set(table.get("unit", pd.Series(dtype=str))) - {""}, reverse=True)
    return " or ".join(units) or IMPLIED["unit"]


def typed(table: pd.DataFrame) -> pd.DataFrame:
    """The table with every column, in order and of its type; what a row lacks is empty.

    Raises:
        ValueError: a column of numbers holds something else.
    """
    whole = table.assign(**{name: said for name, said in IMPLIED.items() if name not in table}).reindex(
        columns=list(COLUMNS)
    )
    return pd.DataFrame({name: _column(whole[name], kind) for name, kind in COLUMNS.items()})


def _column(values: pd.Series, kind: str) -> pd.Series:
    """One column of its type; the empty text of a CSV is no number."""
    if kind == "str":
        return values.fillna("").astype(str)
    given = values.replace("", None)
    try:
        numbers = pd.to_numeric(given, errors="coerce")
    except TypeError as error:
        raise ValueError(f"{values.name} holds something else than numbers") from error
    size = numbers.astype("float64").abs()
    fit = size <= LARGEST if kind == "float64" else (size < 2**63) & (size % 1 == 0)
    bad = given.notna() & ~fit
    if bad.any():
        row, what = int(bad.to_numpy().argmax()), "number" if kind == "float64" else "whole number"
        raise ValueError(f"row {row + 1}: {values.name} is {given.iloc[row]!r}, not a {what}")
    return numbers.astype("float64" if kind == "float64" else "Int64")
