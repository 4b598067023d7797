"""One job of a sweep: fit an agent, play one route, and score every sampling distance asked for."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vprbench.agents import normalise
from vprbench.bootstrap import interval_rule, intervals
from vprbench.catalogue import load_route
from vprbench.encoder_store import EncoderStore
from vprbench.env import RouteEnv
from vprbench.episode import Recording, calibrate, judge, play
from vprbench.errors import PluginError
from vprbench.fitted import fitted_agent
from vprbench.frame_memory import FrameMemory
from vprbench.metrics import evaluate
from vprbench.plugins import one_line
from vprbench.protocols import DescriptorLocalizer, Localizer
from vprbench.provenance import data_checksum, origins, versions
from vprbench.reporting import Report, silent
from vprbench.response_matrix import ResponseMatrix
from vprbench.route import Route
from vprbench.sweep import Cell, Job
from vprbench.trace import Trace

__all__ = ["Outcome", "failure", "run"]

# Stated in every row; the rules that depend on the route are added where it is known.
RECALL_DENOMINATOR = "auc: correct top-1; auc_all: all queries"

# Plays the route at one sampling distance: the vigilance or step used, and the answers.
Player = Callable[[float], tuple[float, Recording]]


@dataclass(frozen=True)
class Outcome:
    """The answer of one cell: its row of the table, and the trace behind it (None where the cell failed)."""

    cell: Cell
    row: dict[str, Any]
    trace: Trace | None


def run(
    job: Job,
    data: Path | None = None,
    routes_file: Path | None = None,
    report: Report = silent,
    store: EncoderStore | None = None,
    memory: FrameMemory | None = None,
) -> Iterator[Outcome]:
    """Answer the cells of a job one by one; a cell that fails is an outcome with its error.

    Args:
        job: its route, agent and cells.
        data: the data root, None for the default.
        routes_file: a TOML with the user's own routes.
        report: is told how far the job has come.
        store: where fitted encoders are kept; None for nowhere.
        memory: of frames that jobs share; None for none.
    """
    try:
        route = load_route(job.route, data=data, routes=routes_file)
        if memory is not None:
            route = memory.share(route)
        player = _prepare(job, route, report, store)
    except Exception as error:
        yield from (failure(job, cell, one_line(error)) for cell in job.cells)
        return
    for cell in job.cells:
        try:
            yield _answer(job, cell, route, player)
        except Exception as error:
            yield failure(job, cell, one_line(error))


def _prepare(job: Job, route: Route, report: Report, store: EncoderStore | None) -> Player:
    """Build and fit the agent; the fastest way to play the route with it."""
    localizer = fitted_agent(job.config, job.seed, route.training, store, report)
    if isinstance(localizer, DescriptorLocalizer):
        return _from_matrix(ResponseMatrix(route, localizer, report))
    return _frame_by_frame(route, localizer, report)


def _from_matrix(matrix: ResponseMatrix[Any]) -> Player:
    """Read the answers from the frame x frame response matrix."""

    def played(sampling_distance: float) -> tuple[float, Recording]:
        sampling = matrix.sampling(sampling_distance)
        return sampling, matrix.recording(sampling)

    return played


def _frame_by_frame(route: Route, localizer: Localizer, report: Report) -> Player:
    """Play the environment."""

    def played(sampling_distance: float) -> tuple[float, Recording]:
        report("calibrate", 0, 1)
        sampling = calibrate(localizer, route, sampling_distance)
        report("play", 0, 1)
        return sampling, play(RouteEnv(route, sampling_distance), localizer)

    return played


def _answer(job: Job, cell: Cell, route: Route, player: Player) -> Outcome:
    """Play and score one cell."""
    sampling, recording = player(cell.sampling_distance)
    if not len(recording.place_frames):
        raise PluginError(f"{cell.agent} made no place on {route.learn.name}")
    trace = judge(route, recording, cell.sampling_distance)
    places = len(recording.place_frames)
    measured = {
        "status": "ok",
        "error": "",
        "environment": route.environment,
        "split": route.split,
        "unit": route.unit,
        "heading_source": route.learn.heading_source,
        "sampling": sampling,
        "places": places,
        "place_spacing_m": route.learn.length / places,
        "learn_frames": len(route.learn),
        "queries": len(route.test),
        "tolerance_mean_m": float(trace.tolerance_m.mean()),
        **evaluate(trace),
        **intervals(trace),
        "tolerance_rule": route.visit.rule,
        "interval_rule": interval_rule(route.unit),
        "data_checksum": data_checksum(route),
    }
    return Outcome(cell, _identity(job, cell) | measured, trace)


def failure(job: Job, cell: Cell, error: str) -> Outcome:
    """The outcome of a cell that failed."""
    return Outcome(cell, _identity(job, cell) | {"status": "failed", "error": error}, None)


def _identity(job: Job, cell: Cell) -> dict[str, Any]:
    """The columns that say which cell a row answers, by which rules, with which code."""
    config = normalise(job.config)
    return {
        "cell": cell.id,
        "route": cell.route,
        "sampling_distance_m": cell.sampling_distance,
        "agent": cell.agent,
        "seed": cell.seed,
        "agent_config": json.dumps(config, sort_keys=True),
        "plugins": origins(config),
        "recall_denominator": RECALL_DENOMINATOR,
        **versions(),
    }
