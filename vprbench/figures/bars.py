"""Mean scores as bars: of each agent, or of each agent on each route or at each sampling distance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float64

from vprbench.columns import length_unit
from vprbench.errors import ConfigError, nearest
from vprbench.figures.panels import distinct, plain, show_legend
from vprbench.figures.style import GREY, INK, agent_colours, caption, house_style, mixed, new_figure
from vprbench.tables.formats import LABELS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["score_bars"]

# Share of a group's place on the axis that its bars fill: those of several agents, or that of one.
_FILLED = 0.86

# Inches of the figure that hold no bars, and the least width of a bar with its number in it.
_MARGIN, _FIGURE = 0.7, 0.24

# Inches that a letter of a group's name takes.
_LETTER = 0.072

_AXES = {"route": "", "sampling_distance_m": "sampling distance, {unit}"}

# What a cell has beside its agent.
_COUNTED = {"route": "route", "sampling_distance_m": "distance", "seed": "seed"}


def score_bars(
    rows: pd.DataFrame,
    metric: str = "auc",
    *,
    by: str | None = None,
    title: str = "",
    names: Mapping[str, str] | None = None,
    axis: str | None = None,
    colours: Mapping[str, str] | None = None,
    paper: Mapping[str, float] | None = None,
) -> Figure:
    """The mean over cells, its standard deviation as whisker, the cells as dots; agents in the order of the rows.

    Args:
        rows: finished cells of a result table.
        metric: a column of them, 0..1.
        by: "route" or "sampling_distance_m": a group of bars for each; none: one bar an agent.
        title: of the figure.
        names: what to call groups, where that is not what the column holds.
        axis: what the groups are.
        colours: of every agent; those of `agent_colours`, if none are given.
        paper: what the paper states of agents, in the unit of the metric; where there are no groups.

    Raises:
        ConfigError: there are no rows, or no such column.
    """
    _require(rows, ["agent", metric, *([by] if by else [])])
    agents = distinct(rows["agent"])
    colours = colours or agent_colours(agents)
    with house_style():
        figure = new_figure(3.3)
        axes = figure.add_subplot()
        # Room for whiskers, though no score is above 100.
        axes.set(ylim=(0.0, 104.0), yticks=range(0, 101, 20), ylabel=f"{_label(metric).split(',')[0]}, %")
        axes.grid(True, axis="y")
        axes.set_title(plain(title))
        if by is None:
            _draw_alone(axes, rows, metric, colours, paper or {})
        else:
            _draw_groups(axes, rows, metric, by, colours)
            _name_groups(axes, _groups(rows, by), names or {})
            axes.set_xlabel(_AXES.get(by, plain(by)).replace("{unit}", length_unit(rows)) if axis is None else axis)
            show_legend(figure, colours, agents)
        quoted = by is None and not set(paper or {}).isdisjoint(agents)
        diamonds = " Diamonds: as the paper states, on its own route." if quoted else ""
        caption(figure, _explained(rows, metric, by) + diamonds)
    return figure


def _require(rows: pd.DataFrame, columns: Sequence[str]) -> None:
    """Refuse what cannot be drawn."""
    if rows.empty:
        raise ConfigError("bars of scores: no finished cell")
    for column in columns:
        if column not in rows:
            raise ConfigError(f"bars of scores: no column {column!r}; {nearest(column, map(str, rows))}")


def _draw_alone(
    axes: Axes, rows: pd.DataFrame, metric: str, colours: Mapping[str, str], paper: Mapping[str, float]
) -> None:
    """One bar an agent, with its name below it, and the paper's figure beside it."""
    agents = distinct(rows["agent"])
    room = _room(axes, len(agents))
    for place, agent in enumerate(agents):
        _bar(axes, place, 0.72, _values(rows[rows["agent"] == agent], metric), colours[agent], room)
        if agent in paper:
            axes.plot(place, 100 * paper[agent], "D", color=INK, markersize=4.5, markerfacecolor="white", zorder=5)
    axes.set_xticks(range(len(agents)), list(map(plain, agents)), rotation=35, ha="right", rotation_mode="anchor")
    axes.tick_params(axis="x", length=0)
    axes.set_xlim(-0.6, len(agents) - 0.4)


def _groups(rows: pd.DataFrame, by: str) -> Sequence[Any]:
    """The values of a column: distances rising, others in the order of the rows."""
    return sorted(rows[by].unique()) if by == "sampling_distance_m" else distinct(rows[by])


def _draw_groups(axes: Axes, rows: pd.DataFrame, metric: str, by: str, colours: Mapping[str, str]) -> None:
    """The agents' bars side by side at each value of a column."""
    agents, groups = distinct(rows["agent"]), _groups(rows, by)
    width = _FILLED / len(agents)
    room = _room(axes, len(groups)) * width
    for place, group in enumerate(groups):
        for turn, agent in enumerate(agents):
            values = _values(rows[(rows[by] == group) & (rows["agent"] == agent)], metric)
            _bar(axes, place + (turn - (len(agents) - 1) / 2) * width, 0.92 * width, values, colours[agent], room)


def _name_groups(axes: Axes, groups: Sequence[Any], names: Mapping[str, str]) -> None:
    """Write the groups' names below them, slanting where they would touch."""
    shown = [f"{group:g}" if isinstance(group, float) else str(group) for group in groups]
    shown = [plain(names.get(name, name)) for name in shown]
    slant = max(map(len, shown)) * _LETTER > _room(axes, len(groups))
    look: dict[str, Any] = {"rotation": 25, "ha": "right", "rotation_mode": "anchor"} if slant else {}
    axes.set_xticks(range(len(groups)), shown, **look)
    axes.tick_params(axis="x", length=0)
    axes.set_xlim(-0.55, len(groups) - 0.45)


def _room(axes: Axes, places: int) -> float:
    """Inches that each place on the axis gets."""
    return (axes.figure.bbox.width / axes.figure.dpi - _MARGIN) / places


def _values(rows: pd.DataFrame, metric: str) -> Float64[np.ndarray, " cells"]:
    return 100 * rows[metric].dropna().to_numpy(float)


def _bar(axes: Axes, x: float, width: float, values: Float64[np.ndarray, " cells"], colour: str, room: float) -> None:
    """The mean of some cells, with its number at its foot where there is room; none where there is no cell."""
    if not values.size:
        return
    mean = float(values.mean())
    axes.bar(x, mean, width, color=mixed(colour, 0.5, "white"), edgecolor=colour, linewidth=0.7, zorder=2)
    if values.size > 1:
        spread = np.linspace(-0.36, 0.36, values.size) * width
        axes.plot(x + spread, values, "o", color=GREY, markersize=2.0, markeredgewidth=0, zorder=3)
        whisker: dict[str, Any] = {"color": INK, "elinewidth": 0.9, "capsize": 2, "capthick": 0.9, "zorder": 4}
        axes.errorbar(x, mean, values.std(ddof=1), **whisker)
    if room >= _FIGURE:
        axes.text(x, 2.0, f"{mean:.1f}", ha="center", va="bottom", fontsize=6, color=INK, zorder=4)


def _label(metric: str) -> str:
    """What a metric is called, and by which definition and rule."""
    rule = ", by the metric rule" if metric.endswith("_metric") else ""
    return LABELS.get(metric.removesuffix("_metric"), metric) + rule


def _explained(rows: pd.DataFrame, metric: str, by: str | None) -> str:
    """What is drawn, over what the means are, and what the marks mean."""
    over = [(name, rows[column].nunique()) for column, name in _COUNTED.items() if column != by and column in rows]
    counted = ", ".join(f"{count} {name}{'' if count == 1 else 's'}" for name, count in over)
    sizes = rows.dropna(subset=metric).groupby([*([by] if by else []), "agent"], sort=False).size()
    cells = f"{sizes.min()}" if sizes.min() == sizes.max() else f"{sizes.min()} to {sizes.max()}"
    one_seed = "; one seed where nothing is random" if rows.groupby("agent")["seed"].nunique().nunique() > 1 else ""
    return (
        f"{_label(metric)[0].upper()}{_label(metric)[1:]}. Bars: means over {cells} cells ({counted}{one_seed}). "
        "Whiskers: their standard deviation. Dots: cells."
    )
