"""How to get the same again."""

from __future__ import annotations

from vprbench.report.markup import fragment
from vprbench.report.material import Material
from vprbench.report.section import Section
from vprbench.sweep import builtin_sweeps

__all__ = ["repeat"]


def repeat(material: Material) -> Section:
    """The commands, and the question in full."""
    name, text = material.name, material.question.text
    builtin = builtin_sweeps().get(name)
    known = builtin is not None and builtin.read_text("utf-8") == text
    commands = [
        f"vprbench sweep {name if known else f'{name}.toml'} --out runs",
        f"vprbench score runs/{name}.csv",
        f"vprbench report runs/{name}.csv",
    ]
    html = fragment(
        "repeat", commands=commands, text=text, file=f"{name}.toml", routes="routes_file" in material.question.says
    )
    return Section("How to get the same again", html)
