"""`vprbench sweep`: from a question on disk to its answer on disk, with progress between."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rich.console import Console

from vprbench.catalogue import catalogue, load_route
from vprbench.cli.progress import SweepProgress
from vprbench.plan import Plan, plan
from vprbench.pool import Progress, Settings, run_all
from vprbench.provenance import data_checksum
from vprbench.results import ResultTable
from vprbench.sweep import Job, Sweep, jobs, load_sweep, matching
from vprbench.tables import make_table, to_terminal

__all__ = ["Request", "sweep_command"]


@dataclass(frozen=True)
class Request:
    """The options of `vprbench sweep`; the command's help says what each means."""

    name: str
    out: Path
    data: Path | None
    routes: Path | None
    jobs: int | None
    filter: str | None
    timeout: float | None
    overwrite: bool
    dry_run: bool


def sweep_command(request: Request) -> int:
    """Run a sweep; exit code 1 if one of its cells failed."""
    console = Console(stderr=True)
    question, sweep = load_sweep(request.name)
    table = ResultTable(request.out, question.stem)
    settings = _settings(request, sweep, question)
    steps = _plan(request, sweep, table, settings)
    todo = jobs(sweep, steps.todo)
    console.print(_announce(question.stem, steps, settings), highlight=False)
    if request.dry_run:
        from vprbench.cli.estimating import print_estimate

        print_estimate(todo, settings, Console())
        return 0
    table.begin(question)
    try:
        _measure(todo, settings, table, console)
    except KeyboardInterrupt:
        console.print("interrupted: what was finished is kept, and the same command goes on from there")
        return 130
    return _conclude(table, console)


def _settings(request: Request, sweep: Sweep, question: Path) -> Settings:
    """How to run it: the command line's routes file wins over the TOML's."""
    own = request.routes or (question.parent / sweep.routes_file if sweep.routes_file else None)
    return Settings(request.jobs or len(os.sched_getaffinity(0)), request.timeout, request.data, own)


def _plan(request: Request, sweep: Sweep, table: ResultTable, settings: Settings) -> Plan:
    """What is to be measured; every route must be known before anything runs."""
    known = catalogue(settings.routes_file)
    for route in sweep.routes:
        known.entry(route)
    cells = list(sweep.cells())
    if request.filter is not None:
        cells = matching(cells, request.filter)

    @cache
    def checksum(route: str) -> str:
        return data_checksum(load_route(route, settings.data, settings.routes_file))

    return plan(sweep, cells, table, checksum, request.overwrite)


def _announce(name: str, steps: Plan, settings: Settings) -> str:
    """What will be done, in one line."""
    parts = [f"{len(steps.todo)} cells to measure with {settings.workers} workers"]
    if steps.changed:
        parts.append(f"{len(steps.changed)} of them because their configuration or data changed")
    if steps.kept:
        parts.append(f"{len(steps.kept)} already there (--overwrite measures them again)")
    return f"[bold]{name}[/bold]: " + ", ".join(parts)


def _measure(todo: Sequence[Job], settings: Settings, table: ResultTable, console: Console) -> None:
    """Run the jobs, storing each cell as it comes."""
    if not todo:
        return
    with SweepProgress(todo, console) as progress:
        for message in run_all(todo, settings):
            if isinstance(message, Progress):
                progress.step(message)
            else:
                table.add(message)
                progress.finish(message)


def _conclude(table: ResultTable, console: Console) -> int:
    """Show the answer, and say where it lies."""
    frame = table.frame()
    failed = frame[frame["status"] != "ok"]
    if len(failed) < len(frame):
        # One legend serves all three.
        shown = [to_terminal(make_table(frame, metric=metric)) for metric in ("auc", "auc_all", "accuracy")]
        for metric_table in shown[:-1]:
            metric_table.caption = None
        Console().print(*shown)
    console.print(f"written: {table.csv} (and .parquet, .toml, .traces/)", highlight=False)
    if len(failed):
        console.print(
            f"[red]{len(failed)} cells failed; the column 'error' says why, and the same command tries again[/red]"
        )
    return 1 if len(failed) else 0
