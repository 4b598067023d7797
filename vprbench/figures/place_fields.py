"""The record phase drawn along the road, as in the paper's figure placeField."""

from __future__ import annotations

from math import floor
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float64

from vprbench.errors import ConfigError
from vprbench.figures.panels import plain
from vprbench.figures.style import COLOURS, GREY, INK, caption, house_style, mixed, new_figure
from vprbench.place_fields import PlaceFields

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["place_field_figure"]

# At most so many metres of road, and about so many places, in one line of the figure: more labels would touch.
_ROW_M, _ROW_PLACES = 100.0, 36

# Inches that a line takes, and the rest of the figure.
_LINE, _REST = 1.35, 0.85

# Of a line's length: the least distance between two labels.
_APART = 0.016

# Neighbours on the road differ in colour; so few colours are told apart at a glance.
_SHADES = COLOURS[:4]


def place_field_figure(fields: PlaceFields) -> Figure:
    """The response of every place along the road, filled where it wins; dashed lines where places were made.

    Raises:
        ConfigError: there are no places.
    """
    if not len(fields.places):
        raise ConfigError(f"figure of place fields: {fields.agent} made no place on {fields.route}")
    starts = _starts(fields)
    with house_style():
        figure = new_figure(_REST + _LINE * (len(starts) - 1))
        lines = figure.subplots(len(starts) - 1, 1, squeeze=False, sharey=True)[:, 0]
        for axes, low, high in zip(lines, starts[:-1], starts[1:], strict=True):
            _draw(axes, fields, low, high)
            _name(axes, fields, low, high, last=high == starts[-1])
            axes.set_xlim(low, high)
            axes.set_ylim(_floor(fields), 1.0)
            axes.set_ylabel("response")
        lines[-1].set_xlabel("road driven, m")
        figure.suptitle(f"{plain(fields.agent)} on {plain(fields.route)}, a place every {fields.sampling_distance:g} m")
        caption(figure, _explained(fields))
    return figure


def _starts(fields: PlaceFields) -> Float64[np.ndarray, " starts"]:
    """Where each line of the figure begins, and where the last ends, metres."""
    length = max(float(fields.distance[-1]), 1e-9)
    lines = max(np.ceil(length / _ROW_M), np.ceil(len(fields.places) / _ROW_PLACES))
    return np.linspace(0.0, length, int(lines) + 1)


def _floor(fields: PlaceFields) -> float:
    """Where the axis of responses begins: 0, but for localizers that answer strongly to anything."""
    return floor(10 * max(0.0, float(fields.responses.min()))) / 10


def _draw(axes: Axes, fields: PlaceFields, low: float, high: float) -> None:
    """What lies between two points of the road, metres, and a little more, which the axes cut off."""
    middle = (fields.distance[:-1] + fields.distance[1:]) / 2
    left, right = np.concatenate([fields.distance[:1], middle]), np.concatenate([middle, fields.distance[-1:]])
    margin = 0.05 * (high - low)
    inside = (right >= low - margin) & (left <= high + margin)
    left, width = left[inside], (right - left)[inside]
    for place in range(len(fields.places)):
        response, colour = fields.responses[inside, place], _SHADES[place % len(_SHADES)]
        axes.plot(fields.distance[inside], response, color=mixed(colour, 0.35, "white"), linewidth=0.6, zorder=3)
        wins = fields.winners[inside] == place
        axes.bar(left[wins], response[wins], width[wins], align="edge", color=colour, alpha=0.6, linewidth=0, zorder=2)


def _name(axes: Axes, fields: PlaceFields, low: float, high: float, *, last: bool) -> None:
    """Where places were made: a dashed line, the place's number above it, and the frame's in brackets."""
    made = fields.distance[fields.places]
    here = np.flatnonzero((made >= low) & ((made < high) | last))
    for place, at, above in zip(here, made[here], _apart(made[here], _APART * (high - low), high), strict=True):
        axes.axvline(at, color=GREY, linewidth=0.6, linestyle=(0, (3, 2)), zorder=4)
        text: dict[str, Any] = {"rotation": 90, "ha": "center", "va": "bottom", "fontsize": 5.5, "color": INK}
        name = f"{place} ({fields.frames[fields.places[place]]})"
        axes.annotate(name, (above, 1.0), (0, 2), ("data", "axes fraction"), "offset points", **text)


def _apart(places: Float64[np.ndarray, " n"], gap: float, end: float) -> Float64[np.ndarray, " n"]:
    """Rising positions pushed apart to at least a gap, none beyond the end as long as there is room."""
    order = np.arange(len(places)) * gap
    pushed = np.maximum.accumulate(places - order) + order
    return np.minimum(pushed, end - order[::-1])


def _explained(fields: PlaceFields) -> str:
    """What the marks mean."""
    lost = int((fields.winners < 0).sum())
    none = f" No place answers at {lost} of {len(fields.winners)} frames." if lost else ""
    return (
        f"The record phase: what each of {len(fields.places)} places answers when the learn drive is driven again. "
        "Dashed: where a place was made, with its number and, in brackets, the frame's. Filled: where it answers most, "
        f"its place field, by which hypotheses are judged.{none}"
    )
