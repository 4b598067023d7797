"""How metrics change with the sampling distance: a line an agent, with its interval."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vprbench.columns import length_unit
from vprbench.figures.panels import distinct, plain, show_legend
from vprbench.figures.style import house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["metrics_by_distance"]

# More agents than this have bars beside each other, since so many bands hide one another; how far they stand apart
# is this share of the least step between two distances.
_BANDS, _APART = 4, 0.5


def metrics_by_distance(rows: pd.DataFrame, metrics: Mapping[str, str], colours: Mapping[str, str]) -> Figure:
    """Routes downwards, metrics across; of several seeds the mean, and an interval that holds all of theirs.

    Intervals are bands, of more than four agents bars.

    Args:
        rows: finished cells of a result table; at least one.
        metrics: columns of the table that have an interval, and what to call each.
        colours: of every agent.
    """
    routes, shifts = distinct(rows["route"]), _shifts(rows)
    with house_style():
        figure = new_figure(1.7 * len(routes) + 0.55)
        grid = figure.subplots(len(routes), len(metrics), squeeze=False, sharex=True, sharey="col")
        for route, line in zip(routes, grid, strict=True):
            line[0].set_ylabel(f"{plain(route)}\n%")
            for metric, axes in zip(metrics, line, strict=True):
                axes.grid(True)
                for agent, group in rows[rows["route"] == route].groupby("agent", sort=False):
                    _draw(axes, group, metric, colours[str(agent)], shifts.get(str(agent)))
        for label, top, bottom in zip(metrics.values(), grid[0], grid[-1], strict=True):
            top.set_title(label)
            bottom.set_xlabel(f"sampling distance, {length_unit(rows)}")
        grid[0, 0].set_xticks(sorted(rows["sampling_distance_m"].unique()))
        show_legend(figure, colours, rows["agent"])
    return figure


def _shifts(rows: pd.DataFrame) -> dict[str, float]:
    """How far each agent's bars stand beside the distance; nothing where they have bands."""
    agents = distinct(rows["agent"])
    if len(agents) <= _BANDS:
        return {}
    distances = np.unique(rows["sampling_distance_m"])
    step = float(np.diff(distances).min()) if len(distances) > 1 else 1.0
    return dict(zip(agents, (_APART * step * np.linspace(-0.5, 0.5, len(agents))).tolist(), strict=True))


def _draw(axes: Axes, rows: pd.DataFrame, metric: str, colour: str, shift: float | None) -> None:
    """The line of one agent on one route, and its band where it has no shift."""
    by_distance = rows.groupby("sampling_distance_m")
    middle = by_distance[metric].mean() * 100
    low, high = by_distance[f"{metric}_low"].min() * 100, by_distance[f"{metric}_high"].max() * 100
    x = middle.index.to_numpy(float) + (shift or 0.0)
    axes.plot(x, middle, color=colour, marker="o", markersize=3.0, linewidth=1.1)
    axes.vlines(x, low, high, color=colour, linewidth=0.8, alpha=0.7)
    if shift is None:
        axes.fill_between(x, low, high, color=colour, alpha=0.13, linewidth=0)
