"""Bars of what encoders measured of themselves, such as the reconstruction rates of each configuration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float64

from vprbench.errors import ConfigError, nearest
from vprbench.figures.style import COLOURS, GREY, INK, WIDTH, caption, house_style, mixed, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["measure_bars"]

# Of a measure on data held out: the paler bar beside that of the data learned from.
_HELD_OUT = "_held_out"

# Inches that a letter of a name takes below the axis, and that stand left of the axis.
_LETTER, _MARGIN = 0.07, 0.6

# Share of an encoder's place on the axis that its bars fill.
_FILLED = 0.8


def measure_bars(
    frame: pd.DataFrame, measures: Sequence[str], *, axis: str = "", names: Mapping[str, str] | None = None
) -> Figure:
    """Bars per encoder, one for each measure: the mean over seeds, its sd as whiskers, and the seeds as dots.

    Args:
        frame: one row a fit, with a column "encoder", drawn in the order of first appearance, and one a measure; a
            value that is not known is NaN.
        measures: of one unit, as they share an axis. "x_held_out" is drawn in a paler colour of "x".
        axis: what they measure, with its unit.
        names: what to call a measure in the legend, where that is not its own name in plain words.

    Raises:
        ConfigError: there is no such column.
    """
    for column in ("encoder", *measures):
        if column not in frame:
            raise ConfigError(f"bars of measures: no column {column!r}; {nearest(column, map(str, frame.columns))}")
    words = {measure: measure.replace(_HELD_OUT, ", held out").replace("_", " ") for measure in measures}
    words |= names or {}
    fits = frame.groupby("encoder", sort=False)
    with house_style():
        figure = new_figure(3.0, min(max(4.0, 1.0 + 0.16 * len(fits) * (len(measures) + 1)), 1.5 * WIDTH))
        axes = figure.add_subplot()
        for place, measure in enumerate(measures):
            seeds = [values.dropna().to_numpy(float) for _, values in fits[measure]]
            _draw(axes, seeds, place, len(measures), label=words[measure], **_look(measure, measures))
        _name(axes, frame["encoder"].drop_duplicates().tolist())
        axes.set_ylabel(axis)
        if len(measures) > 1:
            figure.legend(loc="outside upper left", ncols=4)
        caption(figure, _explained(fits.size()))
    return figure


def _draw(axes: Axes, seeds: Sequence[Float64[np.ndarray, "..."]], place: int, bars: int, **look: Any) -> None:  # noqa: ANN401
    """The bars of one measure, the `place`-th of so many at each encoder; without a value there is none."""
    width = _FILLED / bars
    for encoder, values in enumerate(seeds):
        if not len(values):
            continue
        x = encoder + (place - (bars - 1) / 2) * width
        axes.bar(x, values.mean(), 0.92 * width, **look)
        look["label"] = None
        if len(values) > 1:
            spread = np.linspace(-0.3, 0.3, len(values)) * width
            axes.plot(x + spread, values, "o", color=GREY, markersize=2.6, markeredgecolor="white", markeredgewidth=0.4)
            whisker: dict[str, Any] = {"color": INK, "elinewidth": 0.8, "capsize": 2, "capthick": 0.8, "zorder": 3}
            axes.errorbar(x, values.mean(), values.std(ddof=1), **whisker)


def _look(measure: str, measures: Sequence[str]) -> dict[str, str]:
    """The colours of a measure's bars."""
    learned = list(dict.fromkeys(name.removesuffix(_HELD_OUT) for name in measures))
    colour = COLOURS[learned.index(measure.removesuffix(_HELD_OUT)) % len(COLOURS)]
    return {"facecolor": mixed(colour, 0.6, "white") if measure.endswith(_HELD_OUT) else colour, "edgecolor": colour}


def _name(axes: Axes, encoders: Sequence[str]) -> None:
    """Write the encoders' names below their bars, slanting where they would touch."""
    room = (axes.figure.bbox.width / axes.figure.dpi - _MARGIN) / max(len(encoders), 1)
    slant = max(map(len, encoders), default=0) * _LETTER > room
    axes.set_xticks(range(len(encoders)), encoders, rotation=30 if slant else 0, ha="right" if slant else "center")
    axes.tick_params(axis="x", length=0)
    axes.grid(True, axis="y")


def _explained(fits: pd.Series[int]) -> str:
    least, most = fits.min(), fits.max()
    if most == 1:
        return "One fit each."
    count = f"{most}" if least == most else f"{least} to {most}"
    return f"Bars: mean over {count} seeds. Whiskers: standard deviation over seeds. Dots: seeds."
