"""`vprbench scale`: what agents cost as a map grows to the size of a city."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import pandas as pd
from rich import box
from rich.console import Console, Group
from rich.table import Table
from rich.text import Text

from vprbench.agents import Config, normalise
from vprbench.catalogue import load_route
from vprbench.cli.timing import moving_bar
from vprbench.cli.timing_words import asked_agents, asked_places
from vprbench.encoder_store import EncoderStore
from vprbench.errors import ConfigError
from vprbench.frequency.question import default_question
from vprbench.frequency.rounds import MOST_QUERIES, round_queries
from vprbench.frequency.subjects import fitted
from vprbench.frequency.table import make_table_folder
from vprbench.observation import Drive
from vprbench.provenance import data_checksum, origins
from vprbench.reporting import Report
from vprbench.route import Route
from vprbench.scale.city import City
from vprbench.scale.growth import Limits, Size, grow
from vprbench.scale.table import scale_table, write_scale

__all__ = ["Scaling", "scale_command"]

# What is asked for unless told otherwise (our choice).
AGENTS = "LPMP", "HSD-15-30", "HSD-plus", "CoHOG"
PLACES = [100, 300, 1_000, 3_000, 10_000, 30_000, 100_000]


@dataclass(frozen=True)
class Scaling:
    """The options of `vprbench scale`; the command's help says what each means."""

    agents: Sequence[str]
    route: str
    places: str | None
    queries: int
    limits: Limits
    seed: int
    out: Path
    data: Path | None
    routes: Path | None
    cache: Path | None
    figures: bool


def scale_command(request: Scaling) -> int:
    """Grow and time one agent after the other, and write the table anew at each size; exit code 130 if interrupted."""
    agents = dict(asked_agents(request.agents or AGENTS, default_question()))
    sizes = PLACES if request.places is None else asked_places(request.places)
    if request.figures and find_spec("matplotlib") is None:
        raise ConfigError("--figures needs matplotlib: pip install 'vprbench[figures]'")
    route = load_route(request.route, request.data, request.routes)
    make_table_folder(request.out)
    stamp, grown = _stamp(agents, route, request), {name: list[Size]() for name in agents}
    code = 0
    try:
        with moving_bar(Console(stderr=True)) as report:
            for name, config in agents.items():
                for size in _growing(name, config, sizes, route, request, report):
                    grown[name].append(size)
                    write_scale(scale_table(route.name, grown), stamp, request.out)
    except KeyboardInterrupt:
        finished = sum(map(len, grown.values()))
        Console(stderr=True).print(f"interrupted: {finished} finished sizes are kept", highlight=False)
        code = 130
    if any(grown.values()):
        _conclude(scale_table(route.name, grown), request)
    return code


def _growing(
    name: str, config: Config, sizes: Sequence[int], route: Route, request: Scaling, report: Report
) -> Iterator[Size]:
    """One agent at each size."""

    def told(stage: str, done: int, total: int, note: str = "") -> None:
        report(f"{name}: {note or stage}", done, total)

    agent = fitted(name, config, request.seed, route.training, EncoderStore.under(request.cache), told)
    city = City(route, agent.rehearsal, sizes[-1], request.seed, told)
    drive = Drive(route.test, gps=False)
    rounds = range(-(-request.queries // MOST_QUERIES))
    asked = [drive[frame] for number in rounds for frame in round_queries(number, len(drive))][: request.queries]
    yield from grow(agent, city, asked, sizes, request.limits, told)


def _stamp(agents: Mapping[str, Config], route: Route, request: Scaling) -> dict[str, object]:
    """What was timed, beyond the columns of the table."""
    configs = {name: normalise(config) for name, config in agents.items()}
    return {
        "route": route.name,
        "data_checksum": data_checksum(route),
        "seed": request.seed,
        "limits": {"gigabytes": request.limits.gigabytes, "seconds": request.limits.seconds},
        "agents": {name: {"config": config, "plugins": origins(config)} for name, config in configs.items()},
    }


def _conclude(table: pd.DataFrame, request: Scaling) -> None:
    """Show the table, and say where everything lies."""
    console = Console(stderr=True)
    Console().print(_to_terminal(table), soft_wrap=True)
    written = [str(request.out / "scale.csv"), ".json"]
    if request.figures:
        from vprbench.figures.files import save_figure
        from vprbench.figures.scale import scale_curves

        written.append(str(save_figure(scale_curves(table), request.out / "figures", "scale").svg))
    console.print(f"written: {', '.join(written)}", markup=False, highlight=False, soft_wrap=True)


def _to_terminal(table: pd.DataFrame) -> Group:
    """Each agent's sizes, and what stopped it."""
    drawn = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    drawn.add_column("agent")
    for head in ("places", "query, ms", "of it CPU", "respond, ms", "kB a place", "add, ms", "learn, ms"):
        drawn.add_column(head, justify="right")
    timed, stops = table[table["stopped"] == ""], table[table["stopped"] != ""]
    shown = timed.assign(kilobytes=timed["bytes_per_place"] / 1e3)
    shown = shown[["query_ms", "query_cpu_ms", "respond_ms", "kilobytes", "add_ms", "learn_ms"]]
    for agent, places, values in zip(timed["agent"], timed["places"], shown.to_numpy(float), strict=True):
        drawn.add_row(Text(agent), str(places), *(f"{value:.3g}" for value in values))
    said = (f"{row.agent} stops: {row.places} places {row.stopped}" for row in stops.itertuples())
    return Group(Text(f"{table['route'].iloc[0]}: medians, one thread", "bold"), drawn, *map(Text, said))
