"""The studies that `vprbench reproduce` runs, as data: what each measures, and which figure of the paper that is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from vprbench.errors import ConfigError, nearest
from vprbench.presence import shortfalls
from vprbench.toml_files import read_toml

__all__ = [
    "FitStudy",
    "FrequencyStudy",
    "PlaceFieldsStudy",
    "ScoreFigure",
    "Study",
    "SweepStudy",
    "choose_studies",
    "load_studies",
    "road_for",
]

Grouping = Literal["route", "sampling_distance_m"]


class _Study(BaseModel):
    """What every study states.

    Attributes:
        name: of its files.
        title: what it shows.
        paper: the figures and tables of the paper that it reproduces; empty where the question is our own.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: Annotated[str, Field(pattern=r"^[\w-]+$")]
    title: str
    paper: str = ""


class ScoreFigure(BaseModel):
    """Bars of the scores of a sweep, drawn for each of several metrics.

    Attributes:
        stem: of its files.
        title: what it shows.
        by: a column whose values get a group of bars each; none: one bar an agent.
        routes: those it is of; empty for all. It is not drawn where none was measured.
        agents: likewise.
        names: what to call groups, where that is not what the column holds.
        paper: the AUC that the paper states of agents, 0..1.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    stem: Annotated[str, Field(pattern=r"^[\w-]+$")]
    title: str
    by: Grouping | None = None
    routes: tuple[str, ...] = ()
    agents: tuple[str, ...] = ()
    names: Mapping[str, str] = Field(default_factory=dict)
    paper: Mapping[str, float] = Field(default_factory=dict)


class SweepStudy(_Study):
    """A sweep, on the routes whose data are here, and bars of its scores.

    Attributes:
        sweep: a built-in sweep's name, or a .toml file relative to the file of studies.
        claims: whether its results decide claims of the paper.
        figures: beside those of its report.
    """

    kind: Literal["sweep"]
    sweep: str
    claims: bool = False
    figures: tuple[ScoreFigure, ...] = ()


class _OnOneRoad(_Study):
    """A study of one road.

    Attributes:
        routes: the first whose data are here is taken.
    """

    routes: Annotated[tuple[str, ...], Field(min_length=1)]


class FitStudy(_OnOneRoad):
    """Encoders learned, timed and measured.

    Attributes:
        encoders: names.
        seeds: for encoders that learn from random numbers.
    """

    kind: Literal["fit"]
    encoders: Annotated[tuple[str, ...], Field(min_length=1)]
    seeds: Annotated[tuple[int, ...], Field(min_length=1)]


class FrequencyStudy(_OnOneRoad):
    """Queries a second against places learned, for the agents of data/frequency.toml.

    Attributes:
        agents: some of them; empty for all.
        places: numbers of places; empty for those of that file.
        rounds: how often each is timed; None for what that file says.
    """

    kind: Literal["frequency"]
    agents: tuple[str, ...] = ()
    places: tuple[int, ...] = ()
    rounds: Annotated[int, Field(gt=0)] | None = None


class PlaceFieldsStudy(_OnOneRoad):
    """The record phase of one agent along a road.

    Attributes:
        agent: its configuration.
        label: what to call it.
        sampling_distance: metres between places, on average.
        seed: for agents that learn from random numbers.
    """

    kind: Literal["place-fields"]
    agent: str | dict[str, Any]
    label: str
    sampling_distance: Annotated[float, Field(gt=0)]
    seed: Annotated[int, Field(ge=0)] = 0


Study = SweepStudy | FitStudy | FrequencyStudy | PlaceFieldsStudy


class _File(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    studies: list[Annotated[Study, Field(discriminator="kind")]]


def load_studies(path: Path | None = None) -> list[Study]:
    """The studies of a TOML file; None for those that come with vprbench.

    Raises:
        ConfigError: naming the file and the key.
    """
    source = path or Path(str(files("vprbench") / "data" / "studies.toml"))
    try:
        found = _File.model_validate(read_toml(source)).studies
    except ValidationError as error:
        fault = error.errors(include_url=False)[0]
        raise ConfigError(f"{source}: {'.'.join(map(str, fault['loc']))}: {fault['msg'].lower()}") from error
    names = [study.name for study in found]
    if twice := [name for name in names if names.count(name) > 1]:
        raise ConfigError(f"{source}: two studies are called {twice[0]!r}; rename one")
    return found


def choose_studies(known: Sequence[Study], names: Sequence[str]) -> list[Study]:
    """Those that are named, or all; ConfigError, with the nearest name, where there is none of that name."""
    by_name = {study.name: study for study in known}
    for name in names:
        if name not in by_name:
            raise ConfigError(f"no study is called {name!r}: {nearest(name, by_name)}")
    return [study for study in known if not names or study.name in names]


def road_for(study: _OnOneRoad, data: Path | None) -> tuple[str | None, dict[str, str]]:
    """The first road of a study whose data are here, and what those before it lack."""
    lacking = shortfalls(study.routes, data)
    road = next((name for name in study.routes if name not in lacking), None)
    before = study.routes[: study.routes.index(road)] if road else study.routes
    return road, {name: lacking[name] for name in before}
