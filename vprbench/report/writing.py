"""A report on disk: one page that needs no other file, and beside it every figure and table in formats to reuse."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

import cv2
from markupsafe import Markup

from vprbench.atomic import replacing
from vprbench.errors import DataError
from vprbench.figures.files import save_figure
from vprbench.report.html_tables import to_html
from vprbench.report.markup import fragment
from vprbench.report.material import Material
from vprbench.report.section import Drawing, Section, Sheet
from vprbench.report.sections import SECTIONS
from vprbench.tables import to_csv, to_latex, to_markdown
from vprbench.tables.formats import notes

__all__ = ["write_report"]

_TABLES = {"md": to_markdown, "tex": to_latex, "csv": to_csv}
_JPEG = (cv2.IMWRITE_JPEG_QUALITY, 75, cv2.IMWRITE_JPEG_OPTIMIZE, 1, cv2.IMWRITE_JPEG_PROGRESSIVE, 1)


def write_report(material: Material, folder: Path) -> Path:
    """Write FOLDER/report.html, FOLDER/figures/ and FOLDER/tables/; the path of the page.

    Equal material gives equal bytes.

    Raises:
        DataError: the folder cannot be written.
    """
    page = folder / "report.html"
    sections = [section for make in SECTIONS if (section := make(material)) is not None]
    try:
        (folder / "tables").mkdir(parents=True, exist_ok=True)
        html = _page(material, list(_written(sections, folder, material.colours)))
        with replacing(page) as path:
            path.write_text(html, "utf-8")
    except OSError as error:
        raise DataError(f"{folder}: the report cannot be written ({error.strerror or error})") from error
    return page


def _page(material: Material, sections: list[dict[str, Any]]) -> Markup:
    """The whole page."""
    style = Markup((files("vprbench.report") / "templates" / "style.css").read_text("utf-8"))
    counts = [
        ("agent", len(material.agents)),
        ("route", material.rows["route"].nunique()),
        ("sampling distance", len(material.distances)),
        ("measured cell", len(material.finished)),
    ]
    return fragment("page", material=material, sections=sections, style=style, counts=counts)


def _written(sections: Iterable[Section], folder: Path, colours: Mapping[str, str]) -> Iterator[dict[str, Any]]:
    """Each section as the page needs it, its figures and tables laid down on the way."""
    taken: set[str] = set()
    for section in sections:
        yield {
            "id": _slug(section.title),
            "title": section.title,
            "html": section.html,
            "tables": list(_tables(section.tables, folder, colours)),
            "figures": [_write_figure(drawing, folder, taken) for drawing in section.figures],
        }


def _tables(sheets: Iterable[Sheet], folder: Path, colours: Mapping[str, str]) -> Iterator[Markup]:
    """Lay down each table in every format; its HTML, without the legend of the table before it."""
    told: list[str] = []
    for sheet in sheets:
        for suffix, write in _TABLES.items():
            with replacing(folder / "tables" / f"{sheet.stem}.{suffix}") as path:
                path.write_text(write(sheet.table), "utf-8")
        legend = notes(sheet.table)
        yield to_html(sheet, colours, [] if legend == told else legend)
        told = legend


def _write_figure(drawing: Drawing, folder: Path, taken: set[str]) -> dict[str, str]:
    """Lay down a figure; what the page shows of it."""
    stem = _free(_slug(drawing.stem), taken)
    saved = save_figure(drawing.figure, folder / "figures", stem)
    width, height = drawing.figure.get_size_inches()
    return {
        "source": _embedded(saved.png, drawing.photographic),
        "alt": drawing.alt,
        "caption": drawing.caption,
        "stem": stem,
        "width": f"{width * 100:.0f}",
        "height": f"{height * 100:.0f}",
    }


def _embedded(png: Path, photographic: bool) -> str:
    """A picture as a data URI; camera frames as JPEG, a quarter of the size."""
    if not photographic:
        return f"data:image/png;base64,{b64encode(png.read_bytes()).decode()}"
    picture = cv2.imread(str(png))
    if picture is None:
        raise DataError(f"{png}: not readable as a picture")
    jpeg = cv2.imencode(".jpg", picture, _JPEG)[1]
    return f"data:image/jpeg;base64,{b64encode(jpeg.tobytes()).decode()}"


def _slug(text: str) -> str:
    """A text as part of a file name or address: letters, digits, dots and dashes."""
    return re.sub(r"[^\w.]+", "-", text, flags=re.ASCII).strip("-.").lower()


def _free(stem: str, taken: set[str]) -> str:
    """The stem, or where names differ only in what a file name cannot hold, the stem with a number."""
    names = (stem, *(f"{stem}-{count}" for count in range(2, len(taken) + 3)))
    chosen = next(name for name in names if name not in taken)
    taken.add(chosen)
    return chosen
