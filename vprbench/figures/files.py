"""Figures as files: of equal figures, equal bytes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from vprbench.atomic import replacing
from vprbench.errors import DataError
from vprbench.figures.style import house_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["FigureFiles", "save_figure"]

# Neither the day nor the version of matplotlib belongs to a drawing.
_METADATA: dict[str, dict[str, Any]] = {"png": {"Software": None}, "svg": {"Creator": None, "Date": None}}


class FigureFiles(NamedTuple):
    """Where a figure was written."""

    png: Path
    svg: Path


def save_figure(figure: Figure, folder: Path | str, stem: str) -> FigureFiles:
    """Write a figure as FOLDER/STEM.png, 200 px an inch, and as FOLDER/STEM.svg, which needs no other file or font.

    Raises:
        DataError: it cannot be written there.
    """
    files = FigureFiles(*(Path(folder) / f"{stem}.{kind}" for kind in FigureFiles._fields))
    try:
        files.png.parent.mkdir(parents=True, exist_ok=True)
        for path, kind in zip(files, FigureFiles._fields, strict=True):
            with replacing(path) as temporary, house_style():
                figure.savefig(temporary, format=kind, metadata=_METADATA[kind])
    except OSError as error:
        raise DataError(f"{folder}: the figure {stem!r} cannot be written ({error.strerror or error})") from error
    return files
