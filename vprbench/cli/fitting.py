"""`vprbench fit`: encoders learned, kept, measured and drawn, with what they say of themselves meanwhile."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from vprbench.agents import Config, is_seeded, validate
from vprbench.catalogue import load_route
from vprbench.cli.fit_summary import fits_to_terminal
from vprbench.cli.words import plugin_config
from vprbench.encoder_key import encoder_name
from vprbench.encoder_store import EncoderStore
from vprbench.errors import ConfigError, DataError
from vprbench.fit_table import Fit, FitTable, described
from vprbench.fitted import fitted_encoder
from vprbench.plugins import one_line
from vprbench.protocols import Drawn, Encoder, Storable
from vprbench.route import Route
from vprbench.threads import one_thread

__all__ = ["Fitting", "fit_command"]


@dataclass(frozen=True)
class Fitting:
    """The options of `vprbench fit`; the command's help says what each means."""

    encoders: Sequence[str]
    route: str
    seeds: str
    out: Path
    data: Path | None
    routes: Path | None
    cache: Path | None
    refit: bool
    figures: bool


@dataclass(frozen=True)
class _Task:
    """One encoder to be fitted with one seed."""

    config: Config
    seed: int
    first: bool
    name: str


def fit_command(request: Fitting) -> int:
    """Fit encoders one after the other; exit code 1 if one failed."""
    tasks = list(_tasks(request))
    if request.figures and find_spec("matplotlib") is None:
        raise ConfigError("--figures needs matplotlib: pip install 'vprbench[figures]'")
    route = load_route(request.route, request.data, request.routes)
    table, fits, console = _table(request.out), list[Fit](), Console(stderr=True)
    try:
        with one_thread(), _bars(console) as bars:
            for fit in _fitted(tasks, route, request, bars):
                table.add(fit)
                fits.append(fit)
    except KeyboardInterrupt:
        console.print("interrupted: what was finished is kept, and the same command goes on from there")
        return 130
    if fits:
        _conclude(fits, table, request)
    return 1 if len(fits) < len(tasks) else 0


def _tasks(request: Fitting) -> Iterator[_Task]:
    """Every encoder with every seed that matters to it, checked before any of them runs."""
    try:
        seeds = list(dict.fromkeys(int(seed) for seed in request.seeds.split(",")))
    except ValueError:
        seeds = []
    if not seeds or min(seeds) < 0:
        raise ConfigError(f"--seeds {request.seeds!r}: give whole numbers with commas between, for example 0,1,2")
    for text in dict.fromkeys(request.encoders):
        config = plugin_config(text, "encoder")
        validate(config, "encoder")
        for seed in seeds if is_seeded(config, "encoder") else seeds[:1]:
            yield _Task(config, seed, seed == seeds[0], encoder_name(config, seed))


def _table(folder: Path) -> FitTable:
    """The table in a folder that is made for it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DataError(f"--out {folder}: cannot be written ({error.strerror}); choose another folder") from error
    return FitTable(folder)


def _fitted(tasks: Sequence[_Task], route: Route, request: Fitting, bars: Progress) -> Iterator[Fit]:
    """What each task came to; one that fails is told, and is no reason not to go on."""
    for number, task in enumerate(tasks, 1):
        said = f"{number:>4}/{len(tasks)}  {task.name}  "
        try:
            encoder, fit, remark = _fit(task, route, request, bars)
            _write(encoder, task, request)
        except Exception as error:
            bars.console.print(f"[red]{escape(f'{said}failed: {one_line(error)}')}[/red]", soft_wrap=True)
            continue
        bars.console.print(escape(said + _told(fit, remark)), highlight=False, soft_wrap=True)
        yield fit


def _told(fit: Fit, remark: str) -> str:
    """How long a fit took, and what else there is to tell of it."""
    if not fit.seconds:
        return "learned before, so not timed now (--refit learns it again)"
    return f"{fit.seconds['fit_seconds']:.1f} s" + (f", {remark}" if remark else "")


def _fit(task: _Task, route: Route, request: Fitting, bars: Progress) -> tuple[Encoder, Fit, str]:
    """Learn or restore an encoder while its bar moves."""
    bar = bars.add_task(task.name)

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        bars.update(bar, completed=done, total=total, description=f"{task.name}: {note or stage}")

    store, started = EncoderStore.under(request.cache), perf_counter()
    try:
        done = fitted_encoder(task.config, task.seed, route.training, store, report, again=request.refit)
    finally:
        bars.remove_task(bar)
    seconds = None if done.restored else perf_counter() - started
    return done.encoder, described(task.config, task.seed, route, done.encoder, seconds), done.remark


def _write(encoder: Encoder, task: _Task, request: Fitting) -> None:
    """Put what was learned beside the table, and its drawings if they are asked for."""
    if isinstance(encoder, Storable):
        encoder.save(request.out / f"{task.name}.npz")
    if request.figures and task.first and isinstance(encoder, Drawn):
        from vprbench.figures.files import save_figure

        for stem, figure in encoder.figures().items():
            save_figure(figure, request.out / "figures", f"{task.name}-{stem}")


def _conclude(fits: Sequence[Fit], table: FitTable, request: Fitting) -> None:
    """Show the numbers, and say where everything lies."""
    Console().print(fits_to_terminal(fits), soft_wrap=True)
    written = [str(table.csv), *([str(table.timings)] if table.timings.exists() else []), "*.npz"]
    if request.figures:
        from vprbench.cli.fit_figures import draw_measures

        draw_measures(fits, request.out / "figures")
        written.append(f"{request.out / 'figures'}")
    Console(stderr=True).print(f"written: {', '.join(written)}", highlight=False, soft_wrap=True)


def _bars(console: Console) -> Progress:
    """One bar, for the stage at work."""
    return Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=28),
        TimeElapsedColumn(),
        console=console,
        disable=not console.is_terminal,
        transient=True,
    )
