"""How long a sweep will take: a few frames measured here and now, scaled to the whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

from vprbench.agents import build, build_encoder, normalise
from vprbench.catalogue import load_route
from vprbench.fitting import TrainingFrames, fit
from vprbench.observation import Drive, observe
from vprbench.pool import Settings
from vprbench.protocols import DescriptorLocalizer, Localizer
from vprbench.recruiting import HALVINGS
from vprbench.route import Route
from vprbench.sweep import Job
from vprbench.types import Observation

__all__ = ["Estimate", "estimate"]

# Frames to measure.
SAMPLE = 12

# Metres, so short that every frame becomes a place.
SHORT_STEP = 1e-3


@dataclass(frozen=True)
class Estimate:
    """Work of one job.

    Attributes:
        frames: frames to look at, training frames included; one that is played several times counts each time.
        pairs: frame pairs to compare; 0 for a localizer that can only be played.
        seconds: on one core of this machine.
    """

    frames: int
    pairs: int
    seconds: float


def estimate(job: Job, settings: Settings) -> Estimate:
    """Measure an agent on a few frames of its route.

    Raises:
        VprbenchError: the route's data are missing, or the agent cannot be built.
    """
    route = load_route(job.route, settings.data, settings.routes_file)
    training = sum(len(drive) for drive in route.training)
    for drive in (*route.training, route.learn, route.test):
        # Drawing or opening a drive takes time once, which must not be scaled up.
        observe(drive, 0)
    started = perf_counter()
    # Evenly spread frames, since a calibration may want places that lie apart.
    samples = [Drive(drive)[:: max(1, len(drive) // SAMPLE)] for drive in route.training]
    localizer = _fitted(job, samples)
    fitting = (perf_counter() - started) * training / max(1, sum(map(len, samples)))
    if isinstance(localizer, DescriptorLocalizer):
        work = _by_matrix(job, route, localizer)
    else:
        work = _by_playing(job, route, localizer)
    return Estimate(work.frames + training, work.pairs, work.seconds + fitting)


def _fitted(job: Job, drives: Sequence[Sequence[Observation]]) -> Localizer:
    """The agent, fitted on so little that it is of no other use."""
    table, encoder = normalise(job.config), None
    if "encoder" in table:
        encoder = build_encoder(table["encoder"], job.seed)
        fit(encoder, TrainingFrames(drives))
    localizer = build(job.config, job.seed, encoder)
    localizer.fit(drives)
    return localizer


def _by_matrix(job: Job, route: Route, localizer: DescriptorLocalizer[Any]) -> Estimate:
    """What the response matrix takes: each frame is described once, for all cells together."""
    frames, pairs = len(route.learn) + len(route.test), _pairs(job, route, localizer)
    describing, comparing = _matrix_costs(route, localizer)
    return Estimate(frames, pairs, frames * describing + pairs * comparing)


def _by_playing(job: Job, route: Route, localizer: Localizer) -> Estimate:
    """What playing takes, cell by cell; under vigilance the drive is learned anew at each halving, at the most."""
    seeing, answering = _playing_costs(route, localizer)
    by_vigilance = localizer.recruiting == "vigilance"
    learned = len(route.learn) * (HALVINGS + 1 if by_vigilance else 1)
    asked = len(route.learn) + len(route.test)
    # Only under vigilance does learning ask the places, half of which are there on average.
    answers = asked + (learned / 2 if by_vigilance else 0)
    places = sum(min(len(route.learn), route.learn.length / cell.sampling_distance) for cell in job.cells)
    frames = len(job.cells) * (learned + asked)
    return Estimate(frames, 0, frames * seeing + answers * places * answering)


def _pairs(job: Job, route: Route, localizer: Localizer) -> int:
    """Frame pairs that the response matrix will hold: all learn frames under vigilance, else the places."""
    frames = len(route.learn)
    if localizer.recruiting == "step":
        # Places of several distances share frames; their union is bounded by both.
        free = np.prod([1 - min(1.0, route.learn.length / cell.sampling_distance / frames) for cell in job.cells])
        places = round(frames * (1 - float(free)))
    else:
        places = frames
    return places * (frames + len(route.test))


def _matrix_costs(route: Route, localizer: DescriptorLocalizer[Any]) -> tuple[float, float]:
    """Seconds to get and describe a frame, and to compare a pair."""
    drive = Drive(route.test, gps=False)
    picked = _picked(drive)
    described = [localizer.describe(drive[i]) for i in picked[:2]]
    localizer.compare(described, described)
    started = perf_counter()
    described = [localizer.describe(drive[i]) for i in picked]
    middle = perf_counter()
    localizer.compare(described, described)
    return (middle - started) / SAMPLE, (perf_counter() - middle) / SAMPLE**2


def _playing_costs(route: Route, localizer: Localizer) -> tuple[float, float]:
    """Seconds to get a frame and look at it, and to hold it against one place."""
    learn, test = Drive(route.learn), Drive(route.test, gps=False)
    localizer.clear(1.0 if localizer.recruiting == "vigilance" else SHORT_STEP)
    localizer.learn(learn[0])
    localizer.respond(test[0])
    few = _answering(localizer, test)
    places = 1 + sum(localizer.learn(learn[i]) is not None for i in _picked(learn))
    many = _answering(localizer, test)
    answering = max(0.0, (many - few) / max(1, places - 1))
    return max(0.0, few - answering), answering


def _answering(localizer: Localizer, drive: Drive) -> float:
    """Seconds to get and answer a frame, a typical one: a hiccup of the machine does not count."""
    taken = []
    for i in _picked(drive):
        started = perf_counter()
        localizer.respond(drive[i])
        taken.append(perf_counter() - started)
    return median(taken)


def _picked(drive: Drive) -> list[int]:
    """A few frames from all along a drive."""
    return [int(i) for i in np.linspace(0, len(drive) - 1, SAMPLE)]
