"""HTML from the templates of this package; whatever is put into one is escaped."""

from __future__ import annotations

from functools import cache
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

__all__ = ["fragment", "paragraph"]


def fragment(template: str, **values: Any) -> Markup:  # noqa: ANN401 - templates take anything
    """The HTML of a template, filled in."""
    return Markup(_environment().get_template(f"{template}.html.j2").render(**values))


def paragraph(text: str) -> Markup:
    """A paragraph of plain text."""
    return Markup("<p>{}</p>\n").format(text)


@cache
def _environment() -> Environment:
    return Environment(
        loader=PackageLoader("vprbench.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
