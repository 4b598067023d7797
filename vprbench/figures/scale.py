"""Time a query against the number of places, up to a city."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from vprbench.errors import ConfigError
from vprbench.figures.panels import plain
from vprbench.figures.style import agent_colours, caption, house_style, new_figure

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["scale_curves"]

_NEEDED = ("agent", "places", "query_ms", "query_ms_q1", "query_ms_q3", "queries", "stopped")


def scale_curves(table: pd.DataFrame, colours: Mapping[str, str] | None = None) -> Figure:
    """One line an agent on logarithmic axes, in a band between the quartiles; a cross where a limit stopped it.

    Args:
        table: as `vprbench.scale.table.scale_table` makes it, of one route.
        colours: of the agents; those of `agent_colours`, if none are given.

    Raises:
        ConfigError: it has no rows that were timed, or lacks a column.
    """
    missing = [name for name in _NEEDED if name not in table]
    timed = table if missing else table[table["query_ms"].notna()]
    if missing or timed.empty:
        fault = f"no column {missing[0]!r}" if missing else "no rows that were timed"
        raise ConfigError(f"figure of scale: {fault}; give the scale.csv of `vprbench scale`")
    agents = list(dict.fromkeys(table["agent"]))
    colours = colours or agent_colours(agents)
    with house_style():
        figure = new_figure(4.4)
        axes = figure.add_subplot()
        axes.set(xscale="log", yscale="log", xlabel="places", ylabel="time a query, ms")
        axes.grid(True, axis="both")
        for agent, rows in timed.groupby("agent", sort=False):
            stopped = (table["agent"] == agent) & table["query_ms"].isna()
            _draw(axes, rows.sort_values("places"), str(agent), colours[str(agent)], ended=bool(stopped.any()))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter("{x:,g}")
        figure.legend(loc="outside upper left", ncols=5)
        caption(figure, _explained(table, int(timed["queries"].iloc[0])))
    return figure


def _draw(axes: Axes, rows: pd.DataFrame, agent: str, colour: str, *, ended: bool) -> None:
    """An agent's line and its band, and a cross at its end."""
    places = rows["places"].to_numpy(float)
    middle, low, high = (rows[f"query_ms{end}"].to_numpy(float) for end in ("", "_q1", "_q3"))
    axes.fill_between(places, low, high, color=colour, alpha=0.18, linewidth=0)
    axes.plot(places, middle, color=colour, label=plain(agent), marker="o", markersize=2.6)
    if ended:
        axes.plot(places[-1], middle[-1], "x", color=colour, markersize=8)


def _explained(table: pd.DataFrame, queries: int) -> str:
    """What the marks mean."""
    said = f"Median of {queries} queries on one thread, by the clock on the wall; bands: quartiles."
    if table["query_ms"].isna().any():
        said += " Crosses: more places would have passed a limit of memory or time."
    return said
