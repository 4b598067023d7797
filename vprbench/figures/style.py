"""The style of every figure: small sans-serif type, thin grey lines, colours that the colour-blind can tell apart."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import AbstractContextManager
from itertools import product
from textwrap import fill
from typing import Any

from cycler import cycler
from matplotlib import colors, style
from matplotlib.figure import Figure

__all__ = ["COLOURS", "GREY", "INK", "WIDTH", "agent_colours", "caption", "house_style", "mixed", "new_figure"]

# M. Okabe, K. Ito, "Color universal design", 2008; their yellow, too faint on white, comes last.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#4D4D4D", "#F0E442")

# Of text, and of all that should stand back.
INK, GREY = "#262626", "#8C8C8C"

# Inches: the text width of a page of one column.
WIDTH = 6.5

_FONT = 8.5

_STYLE: dict[str, Any] = {
    "axes.axisbelow": True,
    "axes.edgecolor": GREY,
    "axes.grid.axis": "y",
    "axes.labelcolor": INK,
    "axes.labelsize": _FONT,
    "axes.linewidth": 0.6,
    "axes.prop_cycle": cycler(color=COLOURS),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlesize": _FONT + 0.5,
    "figure.dpi": 200,
    "figure.titlesize": _FONT + 1.5,
    "figure.titleweight": "bold",
    "font.family": "DejaVu Sans",
    "font.size": _FONT,
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.6,
    "hatch.linewidth": 0.5,
    "legend.fontsize": _FONT,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "savefig.dpi": "figure",
    # Ids that do not differ from run to run, and letters as outlines, which look the same everywhere.
    "svg.fonttype": "path",
    "svg.hashsalt": "vprbench",
    "text.color": INK,
    "xtick.color": GREY,
    "xtick.labelcolor": INK,
    "xtick.labelsize": _FONT - 0.5,
    "xtick.major.width": 0.6,
    "ytick.color": GREY,
    "ytick.labelcolor": INK,
    "ytick.labelsize": _FONT - 0.5,
    "ytick.major.width": 0.6,
}


def house_style() -> AbstractContextManager[None]:
    """A block in which things are drawn in this style, whatever the user's own matplotlibrc says."""
    return style.context(_STYLE, after_reset=True)


def new_figure(height: float, width: float = WIDTH) -> Figure:
    """An empty figure, inches, whose parts make room for each other; to be called and filled within `house_style`."""
    return Figure(figsize=(width, height), layout="constrained")


def caption(figure: Figure, text: str) -> None:
    """Write what a figure shows below it, in lines as wide as the figure."""
    characters = int(figure.get_figwidth() * 72 / (_FONT - 1) * 1.85)
    figure.supxlabel(fill(text, characters), x=0.01, ha="left", fontsize=_FONT - 1, color=INK, linespacing=1.35)


def agent_colours(names: Iterable[str]) -> dict[str, str]:
    """A colour (#rrggbb) of its own for each name, in the order of first appearance.

    Give it all names of a report once, and every figure shows an agent in one colour, whichever agents are in it.
    The first eight are the palette; the next eight are those darkened, then lightened, and so on anew.
    """
    shades = [(0.0, "black"), (0.45, "black"), (0.5, "white")]
    wheel = [mixed(colour, *shade) for shade, colour in product(shades, COLOURS)]
    return {name: wheel[place % len(wheel)] for place, name in enumerate(dict.fromkeys(names))}


def mixed(colour: str, share: float, other: str) -> str:
    """A colour (#RRGGBB) with this share, 0..1, of another in it."""
    pairs = zip(colors.to_rgb(colour), colors.to_rgb(other), strict=True)
    red, green, blue = ((1 - share) * one + share * two for one, two in pairs)
    return colors.to_hex((red, green, blue)).upper()
