"""A map of a route: both drives, how far each test frame is from the road learned, and where both go."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vprbench.data_checks.overlap import AWAY, Overlap
from vprbench.figures.maps import show_north, strip
from vprbench.figures.panels import plain
from vprbench.figures.roads import Positions, projection, window_on
from vprbench.figures.style import COLOURS, GREY, INK, caption, house_style, new_figure
from vprbench.route import Route

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["revisit_map"]

# Inches that title, axis, legend and caption take.
_REST = 1.25


def revisit_map(route: Route, beside: Overlap) -> Figure:
    """The learn drive in grey, the test drive over it in blue, orange where it is beyond 3 m; a line to the nearest.

    The road is turned so that its longest side lies across; an arrow shows north. A triangle is where a drive begins.
    """
    project = projection(route.test.positions)
    learn, test = project(route.learn.positions), project(route.test.positions)
    window = window_on(np.concatenate([learn, test]), 1)
    with house_style():
        figure = new_figure(window.inches + _REST)
        axes = figure.add_subplot()
        strip(axes, window)
        axes.spines.bottom.set_visible(True)
        axes.tick_params(bottom=True, labelbottom=True)
        axes.set_xlabel("m")
        _draw(axes, learn, test, beside)
        figure.legend(loc="outside upper left", ncols=4)
        axes.set_title(plain(route.name), color=INK)
        show_north(figure, project)
        caption(figure, _explained(beside))
    return figure


def _draw(axes: Axes, learn: Positions, test: Positions, beside: Overlap) -> None:
    """Both drives, and a line from each far test frame to the learn frame nearest to it."""
    away = beside.distance > AWAY
    for query in np.flatnonzero(away):
        axes.plot(*np.stack([test[query], learn[beside.nearest[query]]]).T, color=COLOURS[1], linewidth=0.4, zorder=2)
    axes.plot(*learn.T, color=GREY, linewidth=1.0, zorder=1, label="learn drive")
    for chosen, colour, label in ((~away, COLOURS[0], "test frame"), (away, COLOURS[1], f"beyond {AWAY:g} m")):
        if chosen.any():
            across, up = test[chosen].T
            axes.scatter(across, up, s=5, color=colour, linewidth=0, zorder=3, label=label)
    for drive, colour in ((learn, GREY), (test, COLOURS[0])):
        axes.plot(*drive[0], marker=">", markersize=5, color=colour, zorder=4, clip_on=False)


def _explained(beside: Overlap) -> str:
    figures = beside.figures()
    return (
        f"From a test frame to the nearest learn frame: {figures['distance_mean_m']:.2f} m on average, sd "
        f"{figures['distance_sd_m']:.2f} m, at most {figures['distance_max_m']:.2f} m. "
        "Triangles: where the drives begin."
    )
