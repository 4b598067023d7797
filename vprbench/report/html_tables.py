"""A result table as HTML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isnan
from typing import NamedTuple

from markupsafe import Markup

from vprbench.report.markup import fragment
from vprbench.report.section import Sheet
from vprbench.tables import Entry
from vprbench.tables.formats import title
from vprbench.tables.model import unit

__all__ = ["to_html"]


class _Shown(NamedTuple):
    """The texts of an entry; empty where it has none."""

    figure: str
    spread: str
    interval: str
    best: bool
    partial: bool


def to_html(sheet: Sheet, colours: Mapping[str, str], legend: Sequence[str]) -> Markup:
    """The table under its title and above its legend; agents are marked with their colours."""
    table = sheet.table
    lines = [
        (
            head,
            colours.get(head, "") if table.axes[0] == "agent" else "",
            [_shown(entry, table.metric) for entry in line],
        )
        for head, line in zip(table.rows, table.entries, strict=True)
    ]
    axis = table.axes[0].removesuffix("_m").replace("_", " ")
    return fragment(
        "table", title=title(table), axis=axis, heads=table.columns, lines=lines, notes=legend, stem=sheet.stem
    )


def _shown(entry: Entry, metric: str) -> _Shown:
    """What to print of an entry, in the unit of its metric."""
    factor, decimals, _ = unit(metric)

    def text(value: float) -> str:
        return f"{value * factor:.{decimals}f}"

    return _Shown(
        text(entry.mean) if entry.cells else "-",
        "" if isnan(entry.sd) else f"± {text(entry.sd)}",
        "" if isnan(entry.low) else f"{text(entry.low)} to {text(entry.high)}",
        entry.best,
        entry.partial,
    )
