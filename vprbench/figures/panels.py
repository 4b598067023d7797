"""Small multiples: one panel for each route and sampling distance, all on the same scale."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from matplotlib.lines import Line2D

from vprbench.figures.style import new_figure
from vprbench.trace import Trace

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Panels", "Run", "distinct", "panels", "plain", "show_legend"]


class Run(NamedTuple):
    """One finished cell of a sweep: what was asked, and every answer."""

    route: str
    distance: float
    agent: str
    seed: int
    trace: Trace


class Panels(NamedTuple):
    """A figure of empty panels, by route (downwards) and sampling distance (across)."""

    figure: Figure
    axes: Mapping[tuple[str, float], Axes]


def distinct(values: Iterable[str]) -> list[str]:
    """Each value once, in the order of first appearance."""
    return list(dict.fromkeys(values))


def plain(name: str) -> str:
    """A name as matplotlib prints it to the letter: it takes $ for mathematics, and _ in front for "do not show"."""
    return f"{' ' if name.startswith('_') else ''}{name}".replace("$", r"\$")


def panels(runs: Sequence[Run], *, height: float, x: str, y: str) -> Panels:
    """Panels for the routes and distances of some runs, `height` inches each; to be called within `house_style`."""
    routes, distances = distinct(run.route for run in runs), sorted({run.distance for run in runs})
    figure = new_figure(height * len(routes) + 0.45)
    grid = figure.subplots(len(routes), len(distances), squeeze=False, sharex=True, sharey=True)
    for route, line in zip(routes, grid, strict=True):
        line[0].set_ylabel(f"{plain(route)}\n{y}")
    for axes in grid.flat:
        axes.grid(True, axis="both")
    for distance, top, bottom in zip(distances, grid[0], grid[-1], strict=True):
        top.set_title(f"a place every {distance:g} m")
        bottom.set_xlabel(x)
    keys = [(route, distance) for route in routes for distance in distances]
    return Panels(figure, dict(zip(keys, grid.flat, strict=True)))


def show_legend(figure: Figure, colours: Mapping[str, str], agents: Iterable[str]) -> None:
    """Name the agents of a figure above its panels, each with its colour."""
    names = distinct(agents)
    lines = [Line2D([], [], color=colours[name], linewidth=2.2) for name in names]
    figure.legend(lines, list(map(plain, names)), loc="outside upper left", ncols=min(len(names), 5), handlelength=1.2)
