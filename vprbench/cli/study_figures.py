"""Bars of the scores of a sweep, as the paper's figures show them."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from vprbench.figures.bars import score_bars
from vprbench.figures.files import save_figure
from vprbench.figures.style import agent_colours
from vprbench.results import read_table
from vprbench.studies import ScoreFigure, SweepStudy
from vprbench.sweep import parse_sweep

__all__ = ["draw_study"]

# AUC saturates; the two others tell methods apart.
_METRICS = ("auc", "auc_all", "accuracy")


def draw_study(study: SweepStudy, results: Path, folder: Path) -> None:
    """Every figure of a study, as FOLDER/STEM-METRIC.png and .svg; one of which nothing was measured is left out."""
    # In the order of the question, not of the alphabet, and each in one colour throughout.
    agents = list(parse_sweep(results.with_suffix(".toml")).agents)
    colours = agent_colours(agents)
    rows = read_table(results)
    rows = rows[rows["status"] == "ok"]
    for figure in study.figures:
        shown = _ordered(_ordered(rows, "route", figure.routes), "agent", figure.agents or agents)
        for metric in _METRICS if len(shown) else ():
            drawn = score_bars(
                shown,
                metric,
                by=figure.by,
                title=figure.title,
                names=figure.names,
                axis=_axis(figure),
                colours=colours,
                paper=figure.paper if metric == "auc" else {},
            )
            save_figure(drawn, folder, f"{figure.stem}-{metric.replace('_', '-')}")


def _ordered(rows: pd.DataFrame, column: str, values: tuple[str, ...] | list[str]) -> pd.DataFrame:
    """The rows that have one of some values in a column, in the order of the values; all as they are, if none."""
    if not values:
        return rows
    kept = rows[rows[column].isin(values)]
    return kept.sort_values(column, key=lambda found: found.map(list(values).index), kind="stable")


def _axis(figure: ScoreFigure) -> str | None:
    """What the groups are; the title says it where they have names of their own."""
    return "" if figure.names else None
