"""A contact sheet: what the camera saw, what the agent took it for, and what it should have found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from matplotlib.figure import Figure

from vprbench.figures.style import COLOURS, GREY, WIDTH, house_style
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Frame

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Example", "contact_sheet"]

_HEADS = ("query", "retrieved", "truth: the nearest learn frame")

# Inches: the gap between frames, the room for a line of text, and a frame.
_GAP, _TEXT = 0.06, 0.22
_WIDE = (WIDTH - 4 * _GAP) / 3
_HIGH = _WIDE * FRAME_HEIGHT / FRAME_WIDTH


class Example(NamedTuple):
    """One answer, in pictures.

    Attributes:
        text: what to say of it, in a line.
        right: whether the answer is right.
        query: the frame asked about.
        retrieved: the frame at which the answered place was learned; None where there is none, or it is not known.
        truth: the learn frame nearest to the query.
    """

    text: str
    right: bool
    query: Frame
    retrieved: Frame | None
    truth: Frame


def contact_sheet(examples: Sequence[Example]) -> Figure:
    """A line an example: query, retrieved and true frame under a line of text; at least one."""
    height = _TEXT + len(examples) * (_TEXT + _HIGH + _GAP)
    with house_style():
        figure = Figure(figsize=(WIDTH, height))
        for column, head in enumerate(_HEADS):
            x = _GAP + column * (_WIDE + _GAP)
            figure.text(x / WIDTH, 1 - 0.14 / height, head, weight="bold", fontsize=8, va="center")
        for line, example in enumerate(examples):
            bottom = height - _TEXT - (line + 1) * (_TEXT + _HIGH + _GAP) + _GAP
            figure.text(_GAP / WIDTH, (bottom + _HIGH + 0.05) / height, example.text, fontsize=7)
            for column, frame in enumerate((example.query, example.retrieved, example.truth)):
                x = _GAP + column * (_WIDE + _GAP)
                axes = figure.add_axes((x / WIDTH, bottom / height, _WIDE / WIDTH, _HIGH / height))
                _show(axes, frame)
                if column == 1:
                    axes.spines[:].set(color=COLOURS[2] if example.right else COLOURS[1], linewidth=2.0)
    return figure


def _show(axes: Axes, frame: Frame | None) -> None:
    """One frame, or the words that there is none."""
    axes.tick_params(left=False, labelleft=False, bottom=False, labelbottom=False)
    axes.spines[:].set(visible=True, color=GREY, linewidth=0.5)
    if frame is None:
        axes.text(0.5, 0.5, "no frame", transform=axes.transAxes, ha="center", va="center", color=GREY)
    else:
        axes.imshow(frame, cmap="gray", vmin=0, vmax=255, aspect="auto")
