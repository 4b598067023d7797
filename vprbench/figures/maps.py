"""Maps of a route: where each agent was right, near, wrong or silent."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from jaxtyping import Bool
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch

from vprbench.figures.panels import Run, distinct, plain
from vprbench.figures.roads import Positions, Projection, Window, left, projection, window_on
from vprbench.figures.style import COLOURS, GREY, INK, house_style, new_figure
from vprbench.trace import Trace
from vprbench.types import NO_PLACE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["route_maps", "show_north", "strip"]

# Inches that a panel's title takes, and that the figure needs besides panels.
_TITLE, _REST = 0.3, 0.75


class _Mark(NamedTuple):
    """How an answer of one kind is drawn."""

    label: str
    colour: str
    marker: str
    size: float


_MARKS = (
    _Mark("right", COLOURS[4], "o", 2.8),
    _Mark("near (right by distance only)", COLOURS[5], "D", 2.6),
    _Mark("wrong", COLOURS[1], "X", 3.6),
    _Mark("no answer", GREY, "s", 2.6),
)

# The queries from which on marks shrink.
_MANY = 110


def route_maps(runs: Sequence[Run], learn: Positions | None = None) -> Figure:
    """One map an agent (downwards) and sampling distance (across), of runs on one route, one seed each.

    The road is turned so that its longest side lies across; an arrow shows north. Right answers lie on the road, the
    other kinds in lanes on the left of it, so that none hides another.

    Args:
        runs: at least one.
        learn: (n, 2) east and north of the first drive, metres, where they are known.
    """
    agents, distances = distinct(run.agent for run in runs), sorted({run.distance for run in runs})
    project = projection(_queries(runs[0]))
    roads = [_queries(runs[0])] if learn is None else [_queries(runs[0]), learn]
    window = window_on(project(np.concatenate(roads)), len(distances))
    with house_style():
        figure = new_figure((window.inches + _TITLE) * len(agents) + _REST)
        grid = figure.subplots(len(agents), len(distances), squeeze=False)
        for axes in grid.flat:
            strip(axes, window)
        for run in runs:
            _draw(grid[agents.index(run.agent), distances.index(run.distance)], run, project, learn, window.lane)
        for axes in grid[-1]:
            axes.spines.bottom.set_visible(True)
            axes.tick_params(bottom=True, labelbottom=True)
        figure.supxlabel("m", fontsize=8)
        _explain(figure, runs)
        show_north(figure, project)
    return figure


def _queries(run: Run) -> Positions:
    return np.column_stack([run.trace.east, run.trace.north])


def strip(axes: Axes, window: Window) -> None:
    """Leave nothing of a panel but its window, at one scale both ways."""
    axes.set(xlim=(window.low[0], window.high[0]), ylim=(window.low[1], window.high[1]), aspect="equal")
    axes.spines[:].set_visible(False)
    axes.tick_params(left=False, labelleft=False, bottom=False, labelbottom=False)


def _kinds(trace: Trace) -> tuple[Bool[np.ndarray, " queries"], ...]:
    """Which answers are of each kind, in the order of the marks."""
    silent = trace.hypothesis == NO_PLACE
    near = trace.correct_metric & ~trace.correct
    return trace.correct, near, ~(trace.correct | near | silent), silent


def _draw(axes: Axes, run: Run, project: Projection, learn: Positions | None, lane: float) -> None:
    """One map, its lanes so many metres apart."""
    road = project(_queries(run))
    aside = lane * left(road)
    if learn is not None:
        axes.plot(*project(learn).T, color=GREY, linewidth=0.7, zorder=1)
    shrunk = float(np.clip(_MANY / len(road), 0.5, 1.0))
    for lanes, (mark, chosen) in enumerate(zip(_MARKS, _kinds(run.trace), strict=True)):
        size, (across, up) = (mark.size * shrunk) ** 2, (road + lanes * aside)[chosen].T
        axes.scatter(across, up, s=size, color=mark.colour, marker=mark.marker, linewidth=0, zorder=2, clip_on=False)
    axes.set_title(f"{plain(run.agent)}, {run.distance:g} m: {run.trace.correct.mean():.0%} right", fontsize=8, pad=10)


def _explain(figure: Figure, runs: Sequence[Run]) -> None:
    """Name the marks that the maps hold."""
    present = [any(kind.any() for kind in kinds) for kinds in zip(*(_kinds(run.trace) for run in runs), strict=True)]
    marks = [mark for mark, shown in zip(_MARKS, present, strict=True) if shown]
    signs = [Line2D([], [], linestyle="none", marker=m.marker, markersize=m.size + 1.5, color=m.colour) for m in marks]
    figure.legend(signs, [mark.label for mark in marks], loc="outside upper left", ncols=4, handletextpad=0.1)


def show_north(figure: Figure, project: Projection) -> None:
    """An arrow to the north in the upper right corner, where the legend leaves room."""
    north = np.array([0.0, 0.08]) @ project.rotation
    middle = np.array([figure.get_figwidth() - 0.32, figure.get_figheight() - 0.24])
    arrow = FancyArrowPatch(tuple(middle - north), tuple(middle + north), arrowstyle="-|>", mutation_scale=7, color=INK)
    arrow.set(transform=figure.dpi_scale_trans, linewidth=0.8)
    figure.add_artist(arrow)
    x, y = (middle + 1.9 * north) / figure.get_size_inches()
    figure.text(x, y, "N", ha="center", va="center", fontsize=7)
