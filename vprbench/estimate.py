"""How long a sweep will take: a few frames measured here and now, scaled to the whole."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import log2
from statistics import median
from time import process_time
from typing import Any, NamedTuple

import numpy as np

from vprbench.agents import build, build_encoder, normalise
from vprbench.catalogue import load_route
from vprbench.encoder_key import encoder_key
from vprbench.fitting import TrainingFrames, fit
from vprbench.frame_memory import FrameMemory
from vprbench.observation import Drive, observe
from vprbench.pool import Settings
from vprbench.protocols import DescriptorLocalizer, Encoder, Localizer, Storable
from vprbench.route import Route, Traverse
from vprbench.scale.held import held_bytes
from vprbench.sweep import Job
from vprbench.threads import one_thread

__all__ = ["Estimate", "Estimator"]

# Frames to measure.
SAMPLE = 12

# Vigilances tried until there are as many places as asked for: 3 to 13, 7.5 on average, for four encoders on three
# roads at 2, 3 and 5 m.
TRIES = 8

# Of a response, in the matrix of all.
RESPONSE_BYTES = 4

# Metres, so short that every frame becomes a place.
SHORT_STEP = 1e-3


@dataclass(frozen=True)
class Estimate:
    """Work of one job, in the time of one processor: whatever else the machine does counts for nothing.

    Attributes:
        frames: frames to look at, training frames included; one that is played several times counts each time.
        pairs: frame pairs to compare; 0 for a localizer that can only be played.
        seconds: on one core of this machine.
        bytes: of descriptions and responses, which are kept until the job ends; 0 for one that can only be played.
    """

    frames: int
    pairs: int
    seconds: float
    bytes: int = 0


@dataclass(frozen=True)
class _Measured:
    """Work of a job but for its encoder's fit and for getting frames, and the seconds of both.

    What `training_seconds` is to be paid for are the training frames that no job before had got.
    """

    work: Estimate
    fit_seconds: float
    training_seconds: float


@dataclass(frozen=True)
class Estimator:
    """Estimates the jobs of one sweep, in the order in which they are to run.

    Jobs that differ in their seed alone take equally long, so one of them is measured. A fit is charged to the first
    job that needs it, and to none where the store has it already. So are the frames of a route, as if one worker played
    all its jobs; those for which its memory has no room are charged to each.
    """

    settings: Settings
    _memory: FrameMemory = field(default_factory=FrameMemory, init=False)
    _frame_seconds: dict[str, float] = field(default_factory=dict, init=False)
    _measured: dict[str, _Measured] = field(default_factory=dict, init=False)
    _fits: set[str] = field(default_factory=set, init=False)

    def estimate(self, job: Job) -> Estimate:
        """What a job takes, measured on a few frames of its route.

        Raises:
            VprbenchError: the route's data are missing, or the agent cannot be built.
        """
        route = self._memory.share(load_route(job.route, self.settings.data, self.settings.routes_file))
        same = json.dumps([job.route, normalise(job.config), [cell.sampling_distance for cell in job.cells]])
        with one_thread():
            seconds = self._getting(job.route, route)
            if same not in self._measured:
                self._measured[same] = _measure(job, route, self._memory, self._frame_seconds[job.route])
                seconds += self._measured[same].training_seconds
        if self._must_fit(job, route):
            seconds += self._measured[same].fit_seconds
        work = self._measured[same].work
        return replace(work, seconds=work.seconds + seconds)

    def _getting(self, name: str, route: Route) -> float:
        """Seconds to read or draw the frames of both drives that no job before has left in the memory."""
        frames = len(route.learn) + len(route.test)
        if name in self._frame_seconds:
            return max(0, frames - self._memory.limit) * self._frame_seconds[name]
        self._frame_seconds[name] = _frame_seconds(route)
        return frames * self._frame_seconds[name]

    def _must_fit(self, job: Job, route: Route) -> bool:
        """Whether nobody has fitted this encoder before."""
        config, store = normalise(job.config).get("encoder"), self.settings.store
        if config is None or store is None:
            return True
        encoder = build_encoder(config, job.seed)
        if not isinstance(encoder, Storable):
            return True
        key = encoder_key(config, job.seed, encoder, route.training)
        known = key in self._fits or store.path(key).exists()
        self._fits.add(key)
        return not known


def _frame_seconds(route: Route) -> float:
    """Seconds to read or draw a frame; a few of both drives are in the memory from now on."""
    _open(route.learn, route.test)
    drives = (Drive(route.learn), Drive(route.test))
    picked = [(drive, i) for drive in drives for i in sorted({*_picked(drive)} - {0})]
    started = process_time()
    for drive, i in picked:
        drive[i]
    return (process_time() - started) / max(1, len(picked))


def _open(*drives: Traverse) -> None:
    """Get a first frame of each: drawing or opening a drive takes time once, which must not be scaled up."""
    for drive in drives:
        observe(drive, 0)


def _measure(job: Job, route: Route, memory: FrameMemory, frame_seconds: float) -> _Measured:
    """Measure an agent on a few frames of its route, given the seconds to get one that is not in the memory."""
    before = memory.kept
    _open(*route.training)
    config = normalise(job.config).get("encoder")
    encoder, fitting = (None, 0.0) if config is None else _fitted(lambda: build_encoder(config, job.seed), route)
    localizer = build(job.config, job.seed, encoder)
    known, started = memory.kept, process_time()
    # Of all frames: how many of them a localizer takes is its own affair.
    localizer.fit([Drive(drive) for drive in route.training])
    calibrating = max(0.0, process_time() - started - (memory.kept - known) * frame_seconds)
    getting = (memory.kept - before) * frame_seconds
    if isinstance(localizer, DescriptorLocalizer):
        work = _by_matrix(job, route, localizer)
    else:
        work = _by_playing(job, route, localizer)
    training = sum(map(len, route.training))
    whole = replace(work, frames=work.frames + training, seconds=work.seconds + calibrating)
    return _Measured(whole, fitting, getting)


def _fitted(make: Callable[[], Encoder], route: Route) -> tuple[Encoder, float]:
    """An encoder fitted on so little that it is of no other use, and the seconds that its whole fit takes.

    Two fits, the second on twice the frames, tell by which power of their number the time grows: a part of it may
    not depend on them, and a fit may have a last step whatever it is given.
    """
    taken, frames = [], []
    # The first is not counted: it may compile.
    for few in (SAMPLE // 2, SAMPLE // 2, SAMPLE):
        sample = TrainingFrames([Drive(drive)[:: max(1, len(drive) // few)][:few] for drive in route.training])
        list(sample)  # from now on in the memory
        encoder, started = make(), process_time()
        fit(encoder, sample)
        taken.append(process_time() - started)
        frames.append(len(sample))
    _, some, twice = taken
    if not 0 < some < twice or frames[2] == frames[1]:
        return encoder, twice
    power = min(1.0, log2(twice / some) / log2(frames[2] / frames[1]))
    return encoder, float(twice * (sum(map(len, route.training)) / frames[2]) ** power)


def _by_matrix(job: Job, route: Route, localizer: DescriptorLocalizer[Any]) -> Estimate:
    """What the response matrix takes: each frame is described once, for all cells together."""
    frames, pairs = len(route.learn) + len(route.test), _pairs(job, route, localizer)
    cost = _matrix_costs(route, localizer)
    kept = round(frames * cost.description_bytes) + RESPONSE_BYTES * frames * len(route.learn)
    return Estimate(frames, pairs, frames * cost.describing + pairs * cost.comparing, kept)


def _by_playing(job: Job, route: Route, localizer: Localizer) -> Estimate:
    """What playing takes, cell by cell; under vigilance the drive is learned anew at each try."""
    seeing, answering = _playing_costs(route, localizer)
    by_vigilance = localizer.recruiting == "vigilance"
    learned = len(route.learn) * (TRIES + 1 if by_vigilance else 1)
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


class _MatrixCosts(NamedTuple):
    """Seconds to describe a frame that is at hand, and to compare a pair; bytes of a description."""

    describing: float
    comparing: float
    description_bytes: float


def _matrix_costs(route: Route, localizer: DescriptorLocalizer[Any]) -> _MatrixCosts:
    """What a few frames cost."""
    drive = Drive(route.test, gps=False)
    picked = _picked(drive)
    described = [localizer.describe(drive[i]) for i in picked[:2]]
    localizer.compare(described, described)
    started = process_time()
    described = [localizer.describe(drive[i]) for i in picked]
    middle = process_time()
    localizer.compare(described, described)
    compared = process_time() - middle
    return _MatrixCosts((middle - started) / SAMPLE, compared / SAMPLE**2, held_bytes(described) / SAMPLE)


def _playing_costs(route: Route, localizer: Localizer) -> tuple[float, float]:
    """Seconds to look at a frame that is at hand, and to hold it against one place."""
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
    """Seconds to answer a frame that is at hand, a typical one: a hiccup of the machine does not count."""
    taken = []
    for i in _picked(drive):
        started = process_time()
        localizer.respond(drive[i])
        taken.append(process_time() - started)
    return median(taken)


def _picked(drive: Drive) -> list[int]:
    """A few frames from all along a drive."""
    return [int(i) for i in np.linspace(0, len(drive) - 1, SAMPLE)]
