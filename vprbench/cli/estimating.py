"""`vprbench sweep --dry-run`: the cells that would run, and how long they would take here."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from vprbench.errors import VprbenchError
from vprbench.estimate import Estimate, Estimator
from vprbench.plugins import one_line
from vprbench.pool import Settings
from vprbench.sweep import Job

__all__ = ["print_estimate"]


def print_estimate(todo: Sequence[Job], settings: Settings, console: Console) -> None:
    """Print one line a job, why some cannot run, and the whole."""
    estimator, costs, faults = Estimator(settings), list[Estimate](), list[str]()
    table = Table(box=None, pad_edge=False)
    for column in ("route / agent / seed", "cells", "frames", "frame pairs", "MB", "seconds"):
        table.add_column(column, justify="left" if column.startswith("route") else "right")
    for job in todo:
        cost = _estimate(estimator, job)
        if isinstance(cost, Estimate):
            costs.append(cost)
            megabytes = f"{cost.bytes / 1e6:.0f}" if cost.bytes else "-"
            numbers = [f"{cost.frames}", str(cost.pairs or "-"), megabytes, f"{cost.seconds:.0f}"]
        else:
            faults.append(f"{job}: {cost}")
            numbers = ["-", "-", "-", "fails"]
        table.add_row(escape(str(job)), str(len(job.cells)), *numbers)
    console.print(table)
    for fault in faults:
        console.print(f"[red]{escape(fault)}[/red]", highlight=False, soft_wrap=True)
    console.print(_whole(costs, len(faults), settings.workers), highlight=False, soft_wrap=True)


def _estimate(estimator: Estimator, job: Job) -> Estimate | str:
    """What a job takes; or why it cannot run, whatever a plug-in raises: a sweep makes a failed row of that."""
    try:
        return estimator.estimate(job)
    except VprbenchError as error:
        return str(error)
    except Exception as error:
        return one_line(error)


def _whole(costs: Sequence[Estimate], failing: int, workers: int) -> str:
    """What all jobs take together."""
    seconds = [cost.seconds for cost in costs]
    elapsed = max([sum(seconds) / workers, *seconds])
    some = f"; {failing} of {failing + len(costs)} jobs will fail, for the reasons above" if failing else ""
    return f"about {elapsed:.0f} s with {workers} workers, each on a core of its own{some}"
