"""`vprbench sweep --dry-run`: the cells that would run, and how long they would take here."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from vprbench.errors import VprbenchError
from vprbench.estimate import Estimator
from vprbench.pool import Settings
from vprbench.sweep import Job

__all__ = ["print_estimate"]


def print_estimate(todo: Sequence[Job], settings: Settings, console: Console) -> None:
    """Print one line a job, and the whole."""
    table = Table(box=None, pad_edge=False)
    for column in ("route / agent / seed", "cells", "frames", "frame pairs", "seconds"):
        table.add_column(column, justify="left" if column.startswith("route") else "right")
    total = longest = 0.0
    estimator = Estimator(settings)
    for job in todo:
        try:
            cost = estimator.estimate(job)
        except VprbenchError as error:
            table.add_row(escape(str(job)), str(len(job.cells)), "", "", f"[red]{escape(str(error))}[/red]")
            continue
        total, longest = total + cost.seconds, max(longest, cost.seconds)
        table.add_row(
            escape(str(job)), str(len(job.cells)), f"{cost.frames}", str(cost.pairs or "-"), f"{cost.seconds:.0f}"
        )
    console.print(table)
    elapsed = max(longest, total / settings.workers)
    console.print(f"about {elapsed:.0f} s with {settings.workers} workers, each on a core of its own", highlight=False)
