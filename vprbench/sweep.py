"""A sweep: the question in a TOML, and the cells (route, sampling distance, agent, seed) that answer it.

From question to answer: a TOML becomes a Sweep, the Sweep its Cells; `plan` leaves those that have no row yet; jobs
group what can share a fitted agent; `pool` runs each Job in a worker, where `runner` makes an Outcome of every Cell;
`results` keeps its row and trace.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from vprbench.agents import Config, is_seeded, validate
from vprbench.errors import ConfigError, PluginError, nearest
from vprbench.toml_files import read_toml

__all__ = ["Cell", "Job", "Sweep", "builtin_sweeps", "jobs", "load_sweep", "matching", "parse_sweep"]

# Names become parts of cell ids, and so of file names.
Name = Annotated[str, Field(pattern=r"^[^/\\\s.][^/\\\s]*$")]


@dataclass(frozen=True, order=True)
class Cell:
    """One measurement: an agent on a route, with a place every `sampling_distance` metres.

    Under vigilance that holds on average; with a step, a place comes at the first frame past it.
    """

    route: str
    agent: str
    sampling_distance: float
    seed: int

    @property
    def id(self) -> str:
        """Readable name, for example KITTI-K5-1/3m/LPMP/s0."""
        return f"{self.route}/{self.sampling_distance:g}m/{self.agent}/s{self.seed}"


@dataclass(frozen=True)
class Job:
    """Cells that share one fitted agent on one route, so that each frame is described only once."""

    route: str
    agent: str
    seed: int
    config: Config
    cells: tuple[Cell, ...]

    def __str__(self) -> str:
        return f"{self.route}/{self.agent}/s{self.seed}"


class Sweep(BaseModel):
    """The grid of one sweep, as its TOML states it.

    Attributes:
        description: what the sweep asks, in a sentence.
        routes: names from `vprbench list routes`, or from the user's own route file.
        sampling_distances: mean road between places, metres.
        seeds: for agents that learn from random numbers; others run once, with the first seed.
        agents: configuration of each agent, by the name it has in the table.
        routes_file: TOML file with routes of the user's own, relative to this file.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    description: str = ""
    routes: Annotated[list[Name], Field(min_length=1)]
    sampling_distances: Annotated[list[Annotated[float, Field(gt=0, allow_inf_nan=False)]], Field(min_length=1)]
    seeds: Annotated[list[Annotated[int, Field(ge=0)]], Field(min_length=1)] = [0]
    agents: Annotated[dict[Name, str | dict[str, Any]], Field(min_length=1)]
    routes_file: Path | None = None

    @field_validator("sampling_distances")
    @classmethod
    def _told_apart(cls, distances: list[float]) -> list[float]:
        """Refuse distances that a cell's id cannot tell apart."""
        shown = [f"{distance:g}" for distance in dict.fromkeys(distances)]
        if len(set(shown)) < len(shown):
            raise ValueError("distances must differ in their first six digits")
        return distances

    def cells(self) -> Iterator[Cell]:
        """Every cell of the grid, in the order of the TOML."""
        for route in dict.fromkeys(self.routes):
            for agent, config in self.agents.items():
                seeds = self.seeds if _is_seeded(config) else self.seeds[:1]
                for seed in dict.fromkeys(seeds):
                    for distance in dict.fromkeys(self.sampling_distances):
                        yield Cell(route, agent, distance, seed)


def _is_seeded(config: Config) -> bool:
    """Whether an agent runs once for each seed; one that does not load fails once."""
    try:
        return is_seeded(config)
    except PluginError:
        return False


def jobs(sweep: Sweep, cells: Sequence[Cell]) -> list[Job]:
    """The cells, grouped by what they can share."""
    groups: dict[tuple[str, str, int], list[Cell]] = {}
    for cell in cells:
        groups.setdefault((cell.route, cell.agent, cell.seed), []).append(cell)
    return [Job(*key, sweep.agents[key[1]], tuple(group)) for key, group in groups.items()]


def matching(cells: Sequence[Cell], pattern: str) -> list[Cell]:
    """The cells whose id holds the pattern; * and ? stand for any text and any character.

    Raises:
        ConfigError: no cell's id does.
    """
    found = [cell for cell in cells if fnmatchcase(cell.id, "*" + pattern.replace("[", "[[]") + "*")]
    if not found:
        raise ConfigError(f"--filter {pattern!r} matches no cell: {nearest(pattern, (cell.id for cell in cells))}")
    return found


def builtin_sweeps() -> dict[str, Path]:
    """The sweeps that come with vprbench, by name; the folder routes/ beside them holds routes of their own."""
    folder = Path(str(files("vprbench") / "sweeps"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_sweep(name: str) -> tuple[Path, Sweep]:
    """A built-in sweep by name, or a sweep of the user's by the path of its TOML.

    Raises:
        ConfigError: naming the file, the key and the nearest allowed name.
    """
    path = Path(name) if name.endswith(".toml") else builtin_sweeps().get(name)
    if path is None:
        raise ConfigError(f"no sweep is called {name!r}: {nearest(name, builtin_sweeps())}, or give a .toml file")
    return path, parse_sweep(path)


def parse_sweep(path: Path) -> Sweep:
    """Read and check the TOML of a sweep, its agents included."""
    tables = read_toml(path)
    try:
        sweep = Sweep.model_validate(tables)
    except ValidationError as error:
        raise ConfigError(f"{path}: {_explain(error)}") from error
    for agent, config in sweep.agents.items():
        try:
            validate(config)
        except ConfigError as error:
            raise ConfigError(f"{path}: agents.{agent}: {error}") from error
        except PluginError:
            # A plug-in that does not load fails its own cells, with its error in their rows, and no others.
            continue
    return sweep


def _explain(error: ValidationError) -> str:
    """What is wrong with a TOML, as one line: an unknown key first, since it may be a known one misspelt."""
    faults = error.errors(include_url=False)
    fault = next((fault for fault in faults if fault["type"] == "extra_forbidden"), faults[0])
    key = ".".join(str(part) for part in fault["loc"])
    if fault["type"] == "extra_forbidden":
        return f"no key is called {key!r}: {nearest(key, Sweep.model_fields)}"
    if fault["type"] == "missing":
        return f"the key {key!r} is missing"
    return f"{key}: {fault['msg'].lower()}, not {fault['input']!r}"
