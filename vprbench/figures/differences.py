"""Paired differences between agents: a dot and its interval for each pair, beside the line of no difference."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vprbench.errors import ConfigError
from vprbench.figures.style import COLOURS, GREY, INK, caption, house_style, new_figure
from vprbench.tables.formats import LABELS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["paired_differences"]

_NEEDED = ("metric", "agent", "reference", "difference", "low", "high", "cells", "queries")

# Inches that a pair takes, and that the axis and the caption take.
_PAIR, _REST = 0.19, 1.1


def paired_differences(frame: pd.DataFrame) -> Figure:
    """What `vprbench.paired.compare` found, the largest difference on top; pale where no difference is shown.

    Args:
        frame: as `compare` gives it, of one metric.

    Raises:
        ConfigError: it has no rows, lacks a column, or holds several metrics.
    """
    _check(frame)
    pairs = frame.sort_values("difference", ascending=False, kind="stable").reset_index(drop=True)
    with house_style():
        figure = new_figure(_REST + _PAIR * len(pairs))
        axes = figure.add_subplot()
        _draw(axes, pairs)
        _name(axes, pairs)
        caption(figure, _explained(pairs))
    return figure


def _check(frame: pd.DataFrame) -> None:
    """Refuse what `compare` does not give."""
    missing = [name for name in _NEEDED if name not in frame]
    if missing or frame.empty or frame["metric"].nunique() > 1:
        fault = f"no column {missing[0]!r}" if missing else "no rows" if frame.empty else "several metrics"
        raise ConfigError(f"figure of differences: {fault}; give what vprbench.paired.compare returns for one metric")


def _draw(axes: Axes, pairs: pd.DataFrame) -> None:
    """Dots and intervals, in percentage points; an interval that is not known is left out."""
    axes.axvline(0.0, color=GREY, linewidth=0.8, zorder=1)
    values = 100 * pairs[["difference", "low", "high"]].to_numpy(float)
    for place, (difference, low, high) in enumerate(values):
        shown = low > 0 or high < 0
        colour = COLOURS[0] if shown else GREY
        if not np.isnan([low, high]).any():
            axes.plot([low, high], [place, place], color=colour, linewidth=1.4, solid_capstyle="round", zorder=2)
        face = colour if shown else "white"
        axes.plot(difference, place, "o", color=colour, markersize=4.2, markerfacecolor=face, zorder=3)


def _name(axes: Axes, pairs: pd.DataFrame) -> None:
    """Whom each row compares; the reference only once where all have the same."""
    references = pairs["reference"].unique()
    alone = len(references) == 1
    agents = [str(agent) for agent in pairs["agent"]]
    versus = [f"{agent} \N{MINUS SIGN} {other}" for agent, other in zip(agents, pairs["reference"], strict=True)]
    axes.set_yticks(range(len(pairs)), agents if alone else versus)
    axes.set_ylim(len(pairs) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x")
    axes.set_xlabel(f"difference{f' from {references[0]}' if alone else ''}, percentage points")
    metric = str(pairs["metric"].iloc[0])
    axes.set_title(LABELS.get(metric.removesuffix("_metric"), metric), color=INK)


def _explained(pairs: pd.DataFrame) -> str:
    """What the marks mean, and what they rest on."""
    rule = "metric rule" if str(pairs["metric"].iloc[0]).endswith("_metric") else "place-field rule"
    cells, queries = (_range(pairs[name]) for name in ("cells", "queries"))
    return (
        f"Mean over {cells} cells (route, distance) with {queries} queries, by the {rule}. Lines: intervals by paired "
        "block bootstrap over the same queries and over dictionary seeds, each pair by itself. Filled blue: the "
        "interval leaves out 0. Hollow grey: no difference shown."
    )


def _range(values: pd.Series) -> str:
    low, high = values.min(), values.max()
    return str(low) if low == high else f"{low} to {high}"
