"""`vprbench data check`: the data of routes held against what a benchmark needs of them."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from vprbench.catalogue import catalogue
from vprbench.data_checks import Finding, RouteCheck, check_route
from vprbench.entries.files import read_entries
from vprbench.errors import ConfigError, nearest
from vprbench.route import Traverse

__all__ = ["DataCheck", "data_check_command"]

_COLOURS = {"error": "red", "warning": "yellow"}
_DRIVES = ("drive", "frames", "metres", "seconds", "metres a frame")
_OVERLAP = {
    "distance_mean_m": ("test frame to nearest learn frame, mean", "{:.2f} m"),
    "distance_sd_m": ("the same, standard deviation", "{:.2f} m"),
    "distance_max_m": ("the same, most", "{:.2f} m"),
    "share_beyond_3_m": ("test frames beyond 3 m", "{:.1%}"),
    "heading_mean_deg": ("heading off the nearest learn frame's, mean", "{:.1f} degrees"),
    "heading_max_deg": ("the same, most", "{:.1f} degrees"),
}


@dataclass(frozen=True)
class DataCheck:
    """The options of `vprbench data check`; the command's help says what each means."""

    names: Sequence[str]
    data: Path | None
    routes: Path | None
    out: Path
    figures: bool
    format: str


def data_check_command(request: DataCheck) -> int:
    """Check routes one by one; 1 if the data of one cannot be used as they are."""
    writers: dict[str, Callable[[RouteCheck], None]] = {"terminal": _print, "json": _print_json}
    if request.format not in writers:
        raise ConfigError(f"--format {request.format!r}: {nearest(request.format, writers)}")
    aside, errors = Console(stderr=True), 0
    for name in _names(request):
        with _bars(aside) as bars:
            done = check_route(name, request.data, request.routes, _reporter(bars))
        writers[request.format](done)
        if request.figures:
            _draw(done, request.out / "figures", aside)
        errors += done.errors
    return 1 if errors else 0


def _names(request: DataCheck) -> Iterable[str]:
    """The routes asked for, each known; without any, those of the user's own file."""
    names = list(request.names) or (list(read_entries(request.routes)) if request.routes else [])
    if not names:
        raise ConfigError("data check: name a route (see: vprbench list routes), or a file of routes with --routes")
    known = catalogue(request.routes)
    for name in names:
        known.entry(name)
    return dict.fromkeys(names)


def _print(done: RouteCheck) -> None:
    """The figures of a route as tables, and each finding in a line below."""
    console = Console()
    console.print(f"[bold]{escape(done.name)}[/bold]", highlight=False)
    if done.route is not None and done.overlap is not None:
        console.print(_drives((done.route.learn, done.route.test, *done.route.training)), soft_wrap=True)
        for key, value in done.overlap.figures().items():
            label, form = _OVERLAP[key]
            console.print(f"{label:45} {form.format(value)}", highlight=False)
    for finding in done.findings:
        console.print(_line(finding), highlight=False, soft_wrap=True)
    warnings = len(done.findings) - done.errors
    console.print(f"{escape(done.name)}: {done.errors} errors, {warnings} warnings", highlight=False)


def _drives(drives: Sequence[Traverse]) -> Table:
    """The size of each drive."""
    table = Table(box=None, pad_edge=False)
    for head in _DRIVES:
        table.add_column(head, justify="left" if head == "drive" else "right")
    for drive in drives:
        seconds = float(drive.times[-1] - drive.times[0])
        step = drive.length / max(len(drive) - 1, 1)
        table.add_row(escape(drive.name), str(len(drive)), f"{drive.length:.1f}", f"{seconds:.1f}", f"{step:.2f}")
    return table


def _line(finding: Finding) -> str:
    return f"[{_COLOURS[finding.severity]}]{finding.severity:8}[/] {escape(str(finding))}"


def _print_json(done: RouteCheck) -> None:
    """One JSON object a line for each route."""
    figures = done.overlap.figures() if done.overlap is not None else {}
    found = [asdict(finding) for finding in done.findings]
    Console().out(json.dumps({"route": done.name, "overlap": figures, "findings": found}), highlight=False)


def _draw(done: RouteCheck, folder: Path, aside: Console) -> None:
    """The map of a route, and where it lies; none of a route that does not load."""
    from vprbench.figures.files import save_figure
    from vprbench.figures.revisit_map import revisit_map

    if done.route is not None and done.overlap is not None:
        files = save_figure(revisit_map(done.route, done.overlap), folder, f"revisit-{done.name}")
        aside.print(f"written: {files.png} (and .svg)", highlight=False, soft_wrap=True)


def _bars(console: Console) -> Progress:
    return Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=28),
        TextColumn("{task.completed:.0f} of {task.total:.0f} frames"),
        TimeElapsedColumn(),
        console=console,
        disable=not console.is_terminal,
        transient=True,
    )


def _reporter(bars: Progress) -> Callable[..., None]:
    """Moves one bar, for the drive whose frames are read."""
    bar = bars.add_task("read", total=0)

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        bars.update(bar, description=stage, completed=done, total=total)

    return report
