"""Where the time of describing a frame goes: each step of log-polar, of HSD-15/30 and of CoHOG, beside the whole.

    pytest tests/benchmarks/test_steps.py --benchmark-only --benchmark-timer=time.process_time

Steps are given what those before them made of the same frame. What the whole takes beyond its steps are calls, copies
and the pages of memory that the system hands out anew.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import cycle
from typing import Any, TypeAlias

import cv2
import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from vprbench.observation import Drive
from vprbench.protocols import Encoder
from vprbench.route import Route
from vprbench.types import Frame, Observation
from vprbench_encoders.focus import FocusDetector, _compete, _local_maxima
from vprbench_encoders.log_polar import sample_log_polar
from vprbench_encoders.resolution import reduced
from vprbench_encoders.whitening import whiten
from vprbench_localizers.cohog import CoHOG
from vprbench_localizers.entropy import SIDE, region_entropy
from vprbench_localizers.hog import cell_histograms
from vprbench_localizers.region_match import describe_regions

# What a step does to one frame, again and again.
Step: TypeAlias = Callable[[], object]

STEPS = {
    "focus points": ("gradient", "saliency", "maxima", "competition"),
    "log-polar": ("whole", "maps"),
    "hsd-15-30": ("whole", "halving and whitening", "views", "layer 1", "layer 2"),
    "cohog": ("whole", "resizing", "entropy", "histograms", "norms"),
}


def steps_of_focus(detector: FocusDetector, frame: Frame) -> dict[str, Step]:
    """The search for focus points, which encoders share."""
    gradient, floor = detector.gradient(frame), np.float32(detector.floor)
    saliency = detector.saliency(gradient, detector.margin - 1)
    candidates = _local_maxima(saliency, floor).T[:, ::-1].astype(np.float32)
    return {
        "gradient": lambda: detector.gradient(frame),
        "saliency": lambda: detector.saliency(gradient, detector.margin - 1),
        "maxima": lambda: _local_maxima(saliency, floor),
        "competition": lambda: _compete(candidates, np.float32(detector.radius), detector.points),
    }


def steps_of_log_polar(encoder: Any, frame: Frame) -> dict[str, Step]:  # noqa: ANN401 - its private parts
    gradient = encoder.focus.gradient(frame)
    points = encoder.focus.find(gradient)
    return {
        "whole": lambda: encoder.encode(frame),
        "maps": lambda: sample_log_polar(gradient, points, encoder._grid),
    }


def steps_of_hsd(encoder: Any, frame: Frame) -> dict[str, Step]:  # noqa: ANN401 - its private parts
    views, (first, second) = encoder._views, encoder.layers
    points = views.points(frame)

    def whitened() -> Any:  # noqa: ANN401
        return whiten(reduced(frame.astype(np.float32), 2), views.cutoff)

    image = whitened()
    seen = views.view.cut(image, points)
    coded = first.pooled(seen)
    return {
        "whole": lambda: encoder.encode(frame),
        "halving and whitening": whitened,
        "views": lambda: views.view.cut(image, points),
        "layer 1": lambda: first.pooled(seen),
        "layer 2": lambda: second.pooled(coded),
    }


def steps_of_cohog(localizer: CoHOG, observation: Observation) -> dict[str, Step]:
    frame = observation["frame"]

    def resized() -> Any:  # noqa: ANN401
        return cv2.resize(frame, (SIDE, SIDE), interpolation=cv2.INTER_LINEAR)

    image = resized()
    cells, kept = cell_histograms(image), region_entropy(image) >= localizer.entropy_threshold
    return {
        "whole": lambda: localizer.describe(observation),
        "resizing": resized,
        "entropy": lambda: region_entropy(image),
        "histograms": lambda: cell_histograms(image),
        "norms": lambda: describe_regions(cells, kept),
    }


@pytest.fixture(scope="module")
def steps(street: Route, fitted_encoder: Callable[[str], Encoder]) -> dict[str, list[dict[str, Step]]]:
    """The steps of each method, for each of a few frames."""
    seen = list(Drive(street.test, gps=False))
    detector, log_polar, hsd, cohog = FocusDetector(), fitted_encoder("log-polar"), fitted_encoder("hsd-15-30"), CoHOG()
    return {
        "focus points": [steps_of_focus(detector, observation["frame"]) for observation in seen],
        "log-polar": [steps_of_log_polar(log_polar, observation["frame"]) for observation in seen],
        "hsd-15-30": [steps_of_hsd(hsd, observation["frame"]) for observation in seen],
        "cohog": [steps_of_cohog(cohog, observation) for observation in seen],
    }


@pytest.mark.benchmark(group="a step of describing one frame")
@pytest.mark.parametrize(("method", "step"), [(method, step) for method, some in STEPS.items() for step in some])
def test_step(benchmark: BenchmarkFixture, steps: dict[str, list[dict[str, Step]]], method: str, step: str) -> None:
    done: Iterator[Step] = cycle([of_frame[step] for of_frame in steps[method]])
    # The first call may compile.
    next(done)()
    benchmark(lambda: next(done)())
