"""Where the vehicle is at every frame of a drive along a street."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float64

from vprbench.street.course import Course
from vprbench.street.parameters import StreetParameters

__all__ = ["Drive", "Motion", "lane", "plan_drive"]

Drive = Literal["learn", "test"]

_RATE = 10.0  # frames a second, as KITTI's

# Metres right of the centreline at which one drives where the street is wide, and where it is narrow.
_LANE_WIDE, _LANE_NARROW = 2.2, 0.3


@dataclass(frozen=True)
class Motion:
    """The poses of one drive.

    Attributes:
        stations, laterals: (n,) along and to the right of the centreline, metres.
        positions: (n, 2) east and north, metres.
        headings: (n,) radians in -pi..pi, clockwise from north.
        pitches: (n,) radians, nose up positive.
        times: (n,) seconds.
    """

    stations: Float64[np.ndarray, " n"]
    laterals: Float64[np.ndarray, " n"]
    positions: Float64[np.ndarray, "n 2"]
    headings: Float64[np.ndarray, " n"]
    pitches: Float64[np.ndarray, " n"]
    times: Float64[np.ndarray, " n"]


def plan_drive(course: Course, parameters: StreetParameters, drive: Drive) -> Motion:
    """The poses of the first ("learn") or second ("test") drive."""
    second = drive == "test"
    rng = np.random.default_rng([parameters.seed, 2, second])
    stations = _stations(parameters, parameters.test_step if second else parameters.learn_step, rng)
    phase = rng.uniform(0, 2 * np.pi, 2)
    laterals = lane(course, stations) - (parameters.lateral_offset if second else 0.0)
    laterals += 0.12 * np.sin(stations / 17.0 + phase[0]) + 0.06 * np.sin(stations / 7.0 + phase[1])
    jitter = rng.normal(0.0, 1.0, (2, len(stations)))
    heading = course.heading_at(stations) + np.arctan(np.gradient(laterals, stations)) + np.radians(0.4) * jitter[0]
    return Motion(
        stations=stations,
        laterals=laterals,
        positions=course.world(stations, laterals),
        headings=(heading + np.pi) % (2 * np.pi) - np.pi,
        pitches=np.radians(0.12) * jitter[1],
        times=np.arange(len(stations)) / _RATE,
    )


def lane(course: Course, stations: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, " n"]:
    """Where one drives: metres to the right of the centreline."""
    return _LANE_WIDE + (_LANE_NARROW - _LANE_WIDE) * course.narrowness_at(stations)


def _stations(parameters: StreetParameters, step: float, rng: np.random.Generator) -> Float64[np.ndarray, " n"]:
    """From 0 to the street's length in steps that slowly vary by a quarter of their mean."""
    count = max(1, round(parameters.length / step))
    phase = rng.uniform(0, 2 * np.pi)
    weights = 1.0 + 0.25 * np.sin(np.arange(count) / 9.0 + phase)
    return np.concatenate([[0.0], np.cumsum(weights)]) * (parameters.length / weights.sum())
