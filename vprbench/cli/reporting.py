"""`vprbench report`: a page, figures and tables of what a sweep left."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from vprbench.report.gathering import read_material
from vprbench.report.writing import write_report

__all__ = ["report_command"]


def report_command(results: Path, out: Path | None, data: Path | None, routes: Path | None) -> None:
    """Write the report of a sweep and say where it is, and of what it is without the pictures."""
    console = Console(stderr=True)
    with console.status("read the results"):
        material = read_material(results, data, routes)
    with console.status("draw"):
        page = write_report(material, out or results.with_suffix(".report"))
    Console().out(str(page), highlight=False)
    for route, absence in material.absent.items():
        console.out(f"without frames of {route}: {absence.remedy}", highlight=False)
    if material.faults:
        console.out(
            f"without the answers of {len(material.faults)} cells: {next(iter(material.faults.values()))}",
            highlight=False,
        )
