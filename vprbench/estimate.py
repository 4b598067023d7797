"""How long a sweep will take: a few frames measured here and now, scaled to the whole."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter

import numpy as np

from vprbench.agents import build
from vprbench.catalogue import load_route
from vprbench.observation import Drive
from vprbench.pool import Settings
from vprbench.protocols import DescriptorLocalizer, Localizer
from vprbench.route import Route
from vprbench.sweep import Job

__all__ = ["Estimate", "estimate"]

SAMPLE = 12


@dataclass(frozen=True)
class Estimate:
    """Work of one job.

    Attributes:
        frames: frames to describe, training frames included.
        pairs: frame pairs to compare.
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
    localizer = build(job.config, job.seed)
    training = sum(len(drive) for drive in route.training)
    started = perf_counter()
    # Evenly spread frames, since a calibration may want places that lie apart.
    samples = [Drive(drive)[:: max(1, len(drive) // SAMPLE)] for drive in route.training]
    localizer.fit(samples)
    fitting = (perf_counter() - started) * training / max(1, sum(map(len, samples)))
    frames, pairs = len(route.learn) + len(route.test), _pairs(job, route, localizer)
    describing, comparing = _costs(route, localizer)
    return Estimate(frames + training, pairs, fitting + frames * describing + pairs * comparing)


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


def _costs(route: Route, localizer: Localizer) -> tuple[float, float]:
    """Seconds to get and describe a frame, and to compare a pair."""
    drive = Drive(route.test, gps=False)
    picked = [int(i) for i in np.linspace(0, len(drive) - 1, SAMPLE)]
    if not isinstance(localizer, DescriptorLocalizer):
        return _streaming_cost(route, localizer), 0.0
    described = [localizer.describe(drive[i]) for i in picked[:2]]
    localizer.compare(described, described)
    started = perf_counter()
    described = [localizer.describe(drive[i]) for i in picked]
    middle = perf_counter()
    localizer.compare(described, described)
    return (middle - started) / SAMPLE, (perf_counter() - middle) / SAMPLE**2


def _streaming_cost(route: Route, localizer: Localizer) -> float:
    """Seconds to learn or answer a frame, for a localizer that can only be played."""
    localizer.clear(0.5)
    started = perf_counter()
    for observation in Drive(route.learn)[:SAMPLE]:
        localizer.learn(observation)
    return (perf_counter() - started) / SAMPLE
