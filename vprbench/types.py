"""What passes between the parts: frames, observations, landmarks, hypotheses."""

from __future__ import annotations

from typing import NamedTuple, NotRequired, TypedDict

import numpy as np
from jaxtyping import Float32, Float64, UInt8

__all__ = [
    "FRAME_HEIGHT",
    "FRAME_WIDTH",
    "NO_PLACE",
    "Frame",
    "Hypothesis",
    "Landmarks",
    "LearningStep",
    "Observation",
    "Responses",
    "hypothesis",
]

# The paper reduces every frame to 642 x 188 pixels.
FRAME_WIDTH = 642
FRAME_HEIGHT = 188

# The place index that means "none": nothing recruited, or no hypothesis.
NO_PLACE = -1

Frame = UInt8[np.ndarray, "188 642"]
Responses = Float32[np.ndarray, " places"]


class Observation(TypedDict):
    """What the vehicle senses at one frame; `gps` only while it learns, `heading` only where the data set has any.

    Shapes and units:
        frame: uint8 (188, 642), grey.
        heading: float64 (1,), radians in -pi..pi, clockwise from the second (north) axis.
        camera: float64 (2,), focal length fx and principal column cx of `frame`, pixels.
        gps: float64 (2,), local east and north, metres; of a route in frames, 0 and the frame's number.
    """

    frame: Frame
    heading: NotRequired[Float64[np.ndarray, "1"]]
    camera: Float64[np.ndarray, "2"]
    gps: NotRequired[Float64[np.ndarray, "2"]]


class Landmarks(NamedTuple):
    """The local views that an encoder found in one frame.

    Shapes and units:
        signatures: float32 (points, size), one row a landmark.
        points: float32 (points, 2), column u and row v of each landmark's centre, pixels.
    """

    signatures: Float32[np.ndarray, "points size"]
    points: Float32[np.ndarray, "points 2"]


class LearningStep(NamedTuple):
    """How far an encoder's learning has come: `done` of `total` steps of a stage, and what to say of it now.

    A stage may end before `total`; `note` is shown live, for example "reconstruction rate 0.54".
    """

    stage: str
    done: int
    total: int
    note: str = ""


class Hypothesis(NamedTuple):
    """The place a localizer believes it is at (`NO_PLACE` for none), and how sure it is, 0..1."""

    place: int
    confidence: float


def hypothesis(responses: Responses) -> Hypothesis:
    """The place that responds most, and its response.

    Empty or NaN responses, and a best response of zero, are no evidence for any place: `NO_PLACE`
    at confidence 0, never place 0. Of equal responses the earliest place wins.
    """
    known = np.nan_to_num(np.asarray(responses, np.float32), nan=0.0)
    if known.size == 0 or known.max() <= 0.0:
        return Hypothesis(NO_PLACE, 0.0)
    best = int(known.argmax())
    return Hypothesis(best, float(known[best]))
