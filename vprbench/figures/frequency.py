"""Queries a second against the number of places learned, as in the paper's figure."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vprbench.errors import ConfigError
from vprbench.figures.panels import plain
from vprbench.figures.style import agent_colours, caption, house_style, new_figure
from vprbench.frequency.crossing import cheaper_from
from vprbench.frequency.question import PaperPoint

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["frequency_curves"]

_NEEDED = ("agent", "places", "query_ms", "query_ms_q1", "query_ms_q3", "rounds")


def frequency_curves(
    table: pd.DataFrame,
    *,
    reference: str = "",
    paper: Iterable[PaperPoint] = (),
    colours: Mapping[str, str] | None = None,
) -> Figure:
    """One line an agent on logarithmic axes, in a band between the quartiles.

    Args:
        table: as `vprbench.frequency.table.as_table` makes it, of one route.
        reference: an agent; a ring marks where another becomes cheaper than it. "" for no marks.
        paper: frequencies that the paper names, drawn hollow beside those of the same agent.
        colours: of the agents; those of `agent_colours`, if none are given.

    Raises:
        ConfigError: it has no rows, or lacks a column.
    """
    missing = [name for name in _NEEDED if name not in table]
    if missing or table.empty:
        fault = f"no column {missing[0]!r}" if missing else "no rows"
        raise ConfigError(f"figure of frequency: {fault}; give the frequency.csv of `vprbench frequency`")
    agents = list(dict.fromkeys(table["agent"]))
    colours = colours or agent_colours(agents)
    with house_style():
        figure = new_figure(4.4)
        axes = figure.add_subplot()
        axes.set(xscale="log", yscale="log", xlabel="places learned", ylabel="queries a second")
        axes.grid(True, axis="both")
        for agent in agents:
            _draw(axes, table[table["agent"] == agent], agent, colours[agent])
        marked = _mark(axes, table, reference, colours) if reference in agents else 0
        quoted = [point for point in paper if point.agent in agents]
        for point in quoted:
            _quote(axes, point, colours[point.agent])
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter("{x:g}")
        figure.legend(loc="outside upper left", ncols=5)
        caption(figure, _explained(table, reference if marked else "", bool(quoted)))
    return figure


def _draw(axes: Axes, rows: pd.DataFrame, agent: str, colour: str) -> None:
    """An agent's line and its band; between the dots, times grow linearly, which bends a line on these axes."""
    rows = rows.sort_values("places")
    places = rows["places"].to_numpy(float)
    dense = np.union1d(places, np.geomspace(places[0], places[-1], 200))
    middle, fast, slow = (1e3 / np.interp(dense, places, rows[f"query_ms{end}"]) for end in ("", "_q1", "_q3"))
    axes.fill_between(dense, slow, fast, color=colour, alpha=0.18, linewidth=0)
    measured = np.searchsorted(dense, places).tolist()
    axes.plot(dense, middle, color=colour, label=plain(agent), marker="o", markersize=2.6, markevery=measured)


def _mark(axes: Axes, table: pd.DataFrame, reference: str, colours: Mapping[str, str]) -> int:
    """Rings where agents become cheaper than the reference; how many."""
    curve = table[table["agent"] == reference].sort_values("places")
    rings = 0
    for agent in dict.fromkeys(table["agent"]):
        start = inf if agent == reference else cheaper_from(table, agent, reference)
        if 0 < start < inf:
            time = np.interp(start, curve["places"].to_numpy(float), curve["query_ms"].to_numpy(float))
            axes.plot(start, 1e3 / time, "o", color=colours[agent], markersize=8, markerfacecolor="none")
            rings += 1
    return rings


def _quote(axes: Axes, point: PaperPoint, colour: str) -> None:
    """A frequency of the paper's."""
    axes.plot(point.places, point.hz, "D", color=colour, markersize=5, markerfacecolor="white", zorder=3)
    label = f"{plain(point.agent)}, paper"
    axes.annotate(label, (point.places, point.hz), (-6, -2.5), textcoords="offset points", ha="right", fontsize=7)


def _explained(table: pd.DataFrame, reference: str, quoted: bool) -> str:
    """What the marks mean."""
    said = f"Median of {table['rounds'].iloc[0]} rounds on one thread, by the clock on the wall; bands: quartiles."
    if reference:
        said += f" Rings: where an agent becomes cheaper than {plain(reference)}."
    if quoted:
        said += " Diamonds: as the paper states them, on its own machine and code."
    return said
