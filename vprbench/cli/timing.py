"""`vprbench frequency`: agents timed against the number of places they have learned."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pandas as pd
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from vprbench.agents import Config, normalise
from vprbench.catalogue import load_route
from vprbench.cli.timing_summary import frequency_to_terminal, remarks
from vprbench.cli.timing_words import asked_agents, asked_places
from vprbench.encoder_store import EncoderStore
from vprbench.errors import ConfigError, PluginError
from vprbench.frequency.filling import Filling
from vprbench.frequency.question import Question, default_question
from vprbench.frequency.rounds import play_rounds
from vprbench.frequency.stopwatch import Visit
from vprbench.frequency.subjects import Subject, fitted, subjects
from vprbench.frequency.table import as_table, make_table_folder, write_table
from vprbench.observation import Drive
from vprbench.provenance import data_checksum, origins
from vprbench.reporting import Report
from vprbench.route import Route

__all__ = ["Timing", "frequency_command", "moving_bar"]


@dataclass(frozen=True)
class Timing:
    """The options of `vprbench frequency`; the command's help says what each means."""

    agents: Sequence[str]
    route: str
    places: str | None
    rounds: int | None
    seed: int
    out: Path
    data: Path | None
    routes: Path | None
    cache: Path | None
    figures: bool


def frequency_command(request: Timing) -> int:
    """Time the agents, and write the table anew after each round; exit code 130 if it was interrupted."""
    question, console = default_question(), Console(stderr=True)
    agents = dict(asked_agents(request.agents, question))
    sizes = list(question.places) if request.places is None else asked_places(request.places)
    rounds = request.rounds or question.rounds
    if request.figures and find_spec("matplotlib") is None:
        raise ConfigError("--figures needs matplotlib: pip install 'vprbench[figures]'")
    route = load_route(request.route, request.data, request.routes)
    make_table_folder(request.out)
    stamp = _stamp(agents, route, request)
    table, finished = None, 0
    try:
        with moving_bar(console) as report:
            timed = _subjects(agents, sizes, route, request, report)
            _tell_missing(timed, agents, sizes, console)
            visits: list[tuple[Visit, ...]] = []
            for done in play_rounds(timed, list(Drive(route.test, gps=False)), rounds, report):
                visits.append(done)
                table, finished = as_table(route.name, timed, visits), len(visits)
                write_table(table, stamp, request.out)
    except KeyboardInterrupt:
        console.print(f"interrupted: {finished} finished rounds are kept")
    if table is not None:
        _conclude(table, question, request)
    return 0 if finished == rounds else 130


def _stamp(agents: Mapping[str, Config], route: Route, request: Timing) -> dict[str, Any]:
    """What was timed, beyond the columns of the table."""
    configs = {name: normalise(config) for name, config in agents.items()}
    return {
        "route": route.name,
        "data_checksum": data_checksum(route),
        "seed": request.seed,
        "agents": {name: {"config": config, "plugins": origins(config)} for name, config in configs.items()},
    }


def _subjects(
    agents: Mapping[str, Config], sizes: Sequence[int], route: Route, request: Timing, report: Report
) -> list[Subject]:
    """Every agent with every number of places."""
    store, made = EncoderStore.under(request.cache), list[Subject]()
    filling = Filling(route, sizes[-1], report)
    for name, config in agents.items():

        def told(stage: str, done: int, total: int, note: str = "", *, name: str = name) -> None:
            report(f"{name}: {note or stage}", done, total)

        made += subjects(fitted(name, config, request.seed, route.training, store, told), filling, sizes, told)
    return made


def _tell_missing(
    made: Sequence[Subject], agents: Mapping[str, Config], sizes: Sequence[int], console: Console
) -> None:
    """Say which agents make fewer places of the frames present than were asked for.

    Raises:
        PluginError: none makes any.
    """
    if not made:
        raise PluginError(f"none of {', '.join(agents)} makes {sizes[0]} places of the frames present")
    for name in agents:
        missing = sorted(set(sizes) - {subject.places for subject in made if subject.agent == name})
        if missing:
            said = f"{name} makes no more places of the frames present: not timed with {', '.join(map(str, missing))}"
            console.print(said, markup=False, highlight=False, soft_wrap=True)


def _conclude(table: pd.DataFrame, question: Question, request: Timing) -> None:
    """Show the frequencies, and say where everything lies."""
    console = Console(stderr=True)
    Console().print(frequency_to_terminal(table, question), soft_wrap=True)
    for remark in remarks(table):
        console.print(remark, markup=False, highlight=False, soft_wrap=True)
    written = [str(request.out / "frequency.csv"), ".json"]
    if request.figures:
        from vprbench.figures.files import save_figure
        from vprbench.figures.frequency import frequency_curves

        figure = frequency_curves(table, reference=question.reference, paper=question.paper)
        written.append(str(save_figure(figure, request.out / "figures", "frequency").svg))
    console.print(f"written: {', '.join(written)}", markup=False, highlight=False, soft_wrap=True)


@contextmanager
def moving_bar(console: Console) -> Iterator[Report]:
    """A report that moves one bar, from stage to stage."""
    columns = TextColumn("{task.description}", markup=False), BarColumn(bar_width=28), TimeElapsedColumn()
    left = TextColumn("left"), TimeRemainingColumn()
    with Progress(*columns, *left, console=console, disable=not console.is_terminal, transient=True) as bars:
        bar, shown = bars.add_task("", total=1), [""]

        def report(stage: str, done: int, total: int, note: str = "") -> None:
            if stage != shown[0]:
                shown[0] = stage
                bars.reset(bar, description=stage)
            bars.update(bar, completed=done, total=total)

        yield report
