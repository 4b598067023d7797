"""Curves of single answers: precision over recall, and how far from the truth they lie."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from vprbench.figures.panels import Run, panels, show_legend
from vprbench.figures.style import GREY, house_style
from vprbench.precision_recall import curve

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["error_distribution", "precision_recall"]

# Metres: less than this no position is known to; nor is an error of no frame at all drawn at zero.
_NEAREST = 0.1


def precision_recall(runs: Sequence[Run], colours: Mapping[str, str]) -> Figure:
    """Precision over recall relative to all queries, one thin line a run, ending at the share of right answers."""
    with house_style():
        figure, axes = panels(runs, height=1.75, x="recall, of all queries", y="precision")
        for run in runs:
            panel, colour = axes[run.route, run.distance], colours[run.agent]
            drawn = curve(run.trace.correct, run.trace.confidence)
            recall = drawn.recall * run.trace.correct.mean()
            panel.plot(recall, drawn.precision, color=colour, linewidth=1.1)
            panel.plot(recall[-1], drawn.precision[-1], color=colour, marker="o", markersize=3.5)
            panel.set(xlim=(0, 1.02), ylim=(0, 1.02))
        show_legend(figure, colours, (run.agent for run in runs))
    return figure


def error_distribution(runs: Sequence[Run], colours: Mapping[str, str], unit: str = "m") -> Figure:
    """Share of all queries answered within so many metres, or frames; a query without an answer never is."""
    with house_style():
        figure, axes = panels(runs, height=1.6, x=f"error, {unit}", y="share of queries")
        for run in runs:
            panel = axes[run.route, run.distance]
            known = np.sort(run.trace.error_m[~np.isnan(run.trace.error_m)])
            share = np.arange(1, len(known) + 1) / len(run.trace)
            panel.step(np.maximum(known, _NEAREST), share, where="post", color=colours[run.agent], linewidth=1.1)
            panel.axvline(run.distance / 2, color=GREY, linewidth=0.8, linestyle=":")
            panel.set(xscale="log", ylim=(0, 1.02))
            panel.xaxis.set_major_formatter("{x:g}")
        show_legend(figure, colours, (run.agent for run in runs))
    return figure
