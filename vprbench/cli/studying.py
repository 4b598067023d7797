"""One study of `vprbench reproduce`: run on the data present, what is there already left alone."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Literal

from rich.console import Console

from vprbench.atomic import replacing
from vprbench.catalogue import load_route
from vprbench.cli.fitting import Fitting, fit_command
from vprbench.cli.sweeping import Request, sweep_command
from vprbench.cli.timing import Timing, frequency_command
from vprbench.encoder_store import EncoderStore
from vprbench.errors import DataError
from vprbench.fitted import fitted_agent
from vprbench.place_fields import record_fields
from vprbench.presence import shortfalls
from vprbench.results import ResultTable
from vprbench.route import Route
from vprbench.studies import FitStudy, FrequencyStudy, PlaceFieldsStudy, Study, SweepStudy, road_for
from vprbench.studies_kept import fields_kept, fields_stamp, fits_missing, frequency_kept
from vprbench.sweep import load_sweep

__all__ = ["Ended", "Interrupted", "Reproduction", "question_of", "run_study"]

# The exit code of a command that Ctrl-C ended.
_INTERRUPTED = 130

State = Literal["done", "already there", "to do", "could not be run", "failed"]


@dataclass(frozen=True)
class Reproduction:
    """The options of `vprbench reproduce`; the command's help says what each means."""

    studies: tuple[str, ...]
    out: Path
    data: Path | None
    jobs: int | None
    cache: Path | None
    file: Path | None
    list: bool
    dry_run: bool


@dataclass(frozen=True)
class Ended:
    """How a study ended.

    Attributes:
        state: in a word.
        note: what else to know.
        lacking: the routes that it could not be run on, and what each lacks.
    """

    state: State
    note: str = ""
    lacking: Mapping[str, str] = field(default_factory=dict)


class Interrupted(Exception):
    """The user wants to stop."""


def run_study(study: Study, request: Reproduction) -> Ended:
    """Run a study, or with `dry_run` say what that would do."""
    if isinstance(study, SweepStudy):
        return _sweep(study, request)
    road, lacking = road_for(study, request.data)
    if road is None:
        return Ended("could not be run", lacking=lacking)
    route, note = load_route(road, request.data), f"on {road}"
    match study:
        case FitStudy():
            return _ended(_fits(study, route, request), note, lacking)
        case FrequencyStudy():
            return _ended(_frequency(study, route, request), note, lacking)
        case PlaceFieldsStudy():
            return _ended(_fields(study, route, request), note, lacking)


def question_of(study: SweepStudy, request: Reproduction) -> str:
    """A built-in sweep's name, or the path of its TOML, which stands beside the file of studies."""
    beside = request.file.parent if request.file else Path()
    return str(beside / study.sweep) if study.sweep.endswith(".toml") else study.sweep


def _sweep(study: SweepStudy, request: Reproduction) -> Ended:
    name = question_of(study, request)
    question, sweep = load_sweep(name)
    own = question.parent / sweep.routes_file if sweep.routes_file else None
    lacking = shortfalls(sweep.routes, request.data, own)
    if lacking.keys() >= set(sweep.routes):
        return Ended("could not be run", lacking=lacking)
    table = ResultTable(request.out, question.stem)
    cells = [cell for cell in sweep.cells() if cell.route not in lacking]
    if request.dry_run:
        missing = sum(table.row(cell) is None for cell in cells)
        note = f"{missing} of {len(cells)} cells to measure (how long: vprbench sweep {name} --present --dry-run)"
        return Ended("to do", note, lacking) if missing else Ended("already there", lacking=lacking)
    options = (request.jobs, None, None, False, False, request.cache)
    code = sweep_command(Request(name, request.out, request.data, None, *options, present=True))
    return _ended(code, f"{len(cells)} cells", lacking)


def _fits(study: FitStudy, route: Route, request: Reproduction) -> int | None:
    """The exit code; None where nothing was missing, or nothing is to be done now."""
    codes = []
    for seeds, encoders in fits_missing(study, route, request.out).items():
        # Learned anew even where a sweep has kept the encoder, since only learning can be timed.
        refit, figures = True, True
        options = (request.data, None, request.cache, refit, figures)
        asked = Fitting(encoders, route.name, ",".join(map(str, seeds)), request.out, *options)
        codes.append(_do(request, partial(fit_command, asked)))
    return max(codes, default=None)


def _frequency(study: FrequencyStudy, route: Route, request: Reproduction) -> int | None:
    if frequency_kept(study, route, request.out):
        return None
    places = ",".join(map(str, study.places)) or None
    options = (request.out, request.data, None, request.cache, True)
    asked = Timing(study.agents, route.name, places, study.rounds, 0, *options)
    return _do(request, partial(frequency_command, asked))


def _fields(study: PlaceFieldsStudy, route: Route, request: Reproduction) -> int | None:
    if fields_kept(study, route, request.out):
        return None
    return _do(request, partial(_record, study, route, request))


def _record(study: PlaceFieldsStudy, route: Route, request: Reproduction) -> int:
    """Record and draw; the stamp comes last, so that what was interrupted is done again."""
    from vprbench.figures.files import save_figure
    from vprbench.figures.place_fields import place_field_figure

    with Console(stderr=True).status("record place fields"):
        store = EncoderStore.under(request.cache)
        localizer = fitted_agent(study.agent, study.seed, route.training, store)
        fields = record_fields(route, localizer, study.sampling_distance, agent=study.label)
        save_figure(place_field_figure(fields), request.out / "figures", study.name)
        with replacing(request.out / f"{study.name}.csv") as path:
            fields.table().to_csv(path, index=False, lineterminator="\n", float_format="%.6f")
        with replacing(request.out / f"{study.name}.json") as path:
            path.write_text(json.dumps(fields_stamp(study, route), indent=1) + "\n", "utf-8")
    return 0


def _do(request: Reproduction, work: Callable[[], int]) -> int:
    """The exit code of some work; -1 where it is only asked what there is to do."""
    if request.dry_run:
        return -1
    try:
        request.out.mkdir(parents=True, exist_ok=True)
        return work()
    except OSError as error:
        raise DataError(
            f"{request.out}: cannot be written ({error.strerror or error}); choose another --out"
        ) from error


def _ended(code: int | None, note: str, lacking: Mapping[str, str]) -> Ended:
    """What an exit code means."""
    if code == _INTERRUPTED:
        raise Interrupted
    states: Mapping[int | None, State] = {None: "already there", -1: "to do", 0: "done"}
    return Ended(states.get(code, "failed"), note, lacking)
