"""What a section of a report consists of, before it is written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from vprbench.tables import Table

__all__ = ["Drawing", "Section", "Sheet"]

NOTHING = Markup()


@dataclass(frozen=True)
class Drawing:
    """A figure, what it is called on disk, and what it says in words.

    Attributes:
        stem: name of its files.
        figure: the figure.
        alt: what it shows, for those who do not see it.
        caption: how to read it.
        photographic: whether it is made of camera frames, which a page holds better as JPEG.
    """

    stem: str
    figure: Figure
    alt: str
    caption: str
    photographic: bool = False


@dataclass(frozen=True)
class Sheet:
    """A result table, and what it is called on disk."""

    stem: str
    table: Table


@dataclass(frozen=True)
class Section:
    """One section of a report: words, then tables, then figures.

    Attributes:
        title: its heading.
        html: its words, safe to put into a page.
        tables: result tables.
        figures: drawings.
    """

    title: str
    html: Markup = NOTHING
    tables: tuple[Sheet, ...] = ()
    figures: tuple[Drawing, ...] = ()
