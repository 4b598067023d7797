"""`vprbench sweep`: from a question on disk to its answer on disk, with progress between."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rich.console import Console
from rich.markup import escape

from vprbench.catalogue import catalogue, load_route
from vprbench.cli.progress import SweepProgress
from vprbench.crew import Effort
from vprbench.data_root import data_root
from vprbench.encoder_store import EncoderStore
from vprbench.errors import DataError
from vprbench.machine import cores
from vprbench.plan import Plan, plan
from vprbench.pool import Progress, Settings, run_all
from vprbench.presence import shortfalls
from vprbench.provenance import data_checksum, versions
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
    cache: Path | None
    present: bool = False


def sweep_command(request: Request) -> int:
    """Run a sweep; exit code 1 if one of its cells failed."""
    console = Console(stderr=True)
    question, sweep = load_sweep(request.name)
    table = ResultTable(request.out, question.stem)
    settings = _settings(request, sweep, question)
    absent = _left_out(sweep, settings, console) if request.present else frozenset[str]()
    steps = _plan(request, sweep, table, settings, absent)
    effort = _effort(settings)
    todo = sorted(jobs(sweep, steps.todo), key=effort, reverse=True)
    console.print(_announce(question.stem, steps, table, sweep, settings), highlight=False)
    if request.dry_run:
        from vprbench.cli.estimating import print_estimate

        print_estimate(todo, settings, Console())
        return 0
    try:
        with table.writing(question, list(sweep.cells()), sweep.routes_file):
            failed = _measure(todo, effort, settings, table, console)
    except KeyboardInterrupt:
        console.print("interrupted: what was finished is kept, and the same command goes on from there")
        return 130
    _conclude(table, failed, console)
    return 1 if failed else 0


def _settings(request: Request, sweep: Sweep, question: Path) -> Settings:
    """How to run it: the command line's routes file wins over the TOML's."""
    own = request.routes or (question.parent / sweep.routes_file if sweep.routes_file else None)
    store = EncoderStore.under(request.cache)
    return Settings(request.jobs or cores(), request.timeout, request.data, own, store)


def _left_out(sweep: Sweep, settings: Settings, console: Console) -> frozenset[str]:
    """The routes whose data are not all here, each told with the reason; DataError where that is every one."""
    absent = shortfalls(sweep.routes, settings.data, settings.routes_file)
    for route, reason in absent.items():
        console.print(escape(f"left out: {route} needs {reason}"), highlight=False, soft_wrap=True)
    if absent.keys() >= set(sweep.routes):
        raise DataError("no route of this sweep has all its data here, for the reasons above")
    return frozenset(absent)


def _plan(request: Request, sweep: Sweep, table: ResultTable, settings: Settings, absent: Collection[str] = ()) -> Plan:
    """What is to be measured; data root and routes must be known before anything runs."""
    data_root(settings.data)
    known = catalogue(settings.routes_file)
    for route in sweep.routes:
        known.entry(route)
    cells = list(sweep.cells())
    if request.filter is not None:
        cells = matching(cells, request.filter)
    cells = [cell for cell in cells if cell.route not in absent]

    @cache
    def checksum(route: str) -> str:
        return data_checksum(load_route(route, settings.data, settings.routes_file))

    return plan(sweep, cells, table, checksum, request.overwrite)


def _effort(settings: Settings) -> Effort:
    """How much a job takes by the length of its route: the pairs of frames that its response matrix may hold."""

    @cache
    def pairs(name: str) -> int:
        try:
            route = load_route(name, settings.data, settings.routes_file)
        except DataError:
            return 0
        return len(route.learn) * (len(route.learn) + len(route.test))

    return lambda job: pairs(job.route)


def _announce(name: str, steps: Plan, table: ResultTable, sweep: Sweep, settings: Settings) -> str:
    """What will be done, in one line."""
    rows = [row for row in map(table.row, steps.kept) if row is not None]
    older = sum(row["commit"] != versions()["commit"] for row in rows)
    strangers = len(table.strangers(list(sweep.cells())))
    parts = [
        f"{len(steps.todo)} cells to measure with {settings.workers} workers",
        f"{len(steps.changed)} of them because their configuration, plug-in version or data changed",
        f"{len(steps.kept)} already there (--overwrite measures them again)",
        f"{older} of them by another commit of vprbench",
        f"{strangers} rows that answer no cell of this sweep go to {name}.previous.csv",
    ]
    counts = (1, len(steps.changed), len(steps.kept), older, strangers)
    return f"[bold]{escape(name)}[/bold]: " + ", ".join(part for part, n in zip(parts, counts, strict=True) if n)


def _measure(todo: Sequence[Job], effort: Effort, settings: Settings, table: ResultTable, console: Console) -> int:
    """Run the jobs, storing each cell as it comes; how many failed."""
    failed = 0
    if not todo:
        return failed
    with SweepProgress(todo, console) as progress:
        for message in run_all(todo, effort, settings):
            if isinstance(message, Progress):
                progress.step(message)
            else:
                failed += message.trace is None
                table.add(message)
                progress.finish(message)
    return failed


def _conclude(table: ResultTable, failed: int, console: Console) -> None:
    """Show the answer, and say where it lies."""
    frame = table.frame()
    if (frame["status"] == "ok").any():
        # One legend serves all three.
        for metric in ("auc", "auc_all", "accuracy"):
            shown = to_terminal(make_table(frame, metric=metric), legend=metric == "accuracy")
            Console().print(shown, soft_wrap=True)
    console.print(f"written: {table.csv} (and .parquet, .toml, .traces/)", highlight=False, soft_wrap=True)
    if failed:
        console.print(f"[red]{failed} cells failed, for the reasons above; the same command tries them again[/red]")
