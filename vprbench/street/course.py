"""The course of a street: its centreline on the ground plane, and its width along the way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64

from vprbench.street.parameters import Environment

__all__ = ["AHEAD", "BEHIND", "SPACING", "Course", "build_course"]

# The street goes on behind the first frame and ahead of the last, so that nobody sees its end (metres).
BEHIND = 30.0
AHEAD = 160.0
# Distance between the samples of the centreline, metres.
SPACING = 0.5

# Half the width of the road and the distance of the facades from its middle, metres: where the street is wide,
# and where it is narrow.
_HALF_ROAD = (5.6, 3.8)
_FACADE = (14.0, 6.2)

_FINE = 10  # integration steps to a sample

Stations = Float64[np.ndarray, " n"]


@dataclass(frozen=True)
class Course:
    """A sampled centreline; a station is the distance along it, lateral is metres to its right.

    Attributes:
        centre: (n, 2) east and north, metres.
        heading: (n,) radians clockwise from north, not wrapped.
        narrowness: (n,) 0 where the street is wide, 1 where it is narrow.
    """

    centre: Float64[np.ndarray, "n 2"]
    heading: Stations
    narrowness: Stations

    @property
    def stations(self) -> Stations:
        """Station of each sample, metres; 0 is the start of the drives."""
        return np.arange(len(self.heading)) * SPACING - BEHIND

    def heading_at(self, station: Stations) -> Stations:
        """Direction of the street, radians clockwise from north."""
        return np.interp(station, self.stations, self.heading)

    def narrowness_at(self, station: Stations) -> Stations:
        """How narrow the street is there, 0..1."""
        return np.interp(station, self.stations, self.narrowness)

    def half_road_at(self, station: Stations) -> Stations:
        """Half the width of the road, metres."""
        return _blend(_HALF_ROAD, self.narrowness_at(station))

    def facade_at(self, station: Stations) -> Stations:
        """Distance of the facades from the middle of the road, metres."""
        return _blend(_FACADE, self.narrowness_at(station))

    def world(self, station: Stations, lateral: Stations) -> Float64[np.ndarray, "n 2"]:
        """East and north of points given along and across the street, metres."""
        heading = self.heading_at(station)
        centre = np.stack([np.interp(station, self.stations, self.centre[:, axis]) for axis in (0, 1)], -1)
        right = np.stack([np.cos(heading), -np.sin(heading)], -1)
        return centre + np.asarray(lateral)[..., None] * right


def build_course(environment: Environment, length: float, seed: int) -> Course:
    """The course of one street; the same arguments always give the same one."""
    rng = np.random.default_rng([seed, 1])
    fine = np.arange(round((length + BEHIND + AHEAD) / SPACING) * _FINE + 1) * (SPACING / _FINE) - BEHIND
    heading = np.full(fine.shape, rng.uniform(-np.pi, np.pi))
    for start, span, angle in _bends(environment, length, rng):
        x = np.clip((fine - start) / span, 0.0, 1.0)
        heading += angle * (x - np.sin(2 * np.pi * x) / (2 * np.pi))  # curvature rises and falls as 1 - cos
    steps = np.stack([np.sin(heading), np.cos(heading)], -1) * (SPACING / _FINE)
    centre = np.cumsum(steps, axis=0) - steps[0]
    centre -= centre[np.searchsorted(fine, 0.0)]
    narrowness = _narrowness(environment, fine[::_FINE], rng)
    return Course(centre[::_FINE], heading[::_FINE], narrowness)


def _blend(values: tuple[float, float], narrowness: Stations) -> Stations:
    return values[0] + (values[1] - values[0]) * narrowness


def _bends(environment: Environment, length: float, rng: np.random.Generator) -> list[tuple[float, float, float]]:
    """Start station (m), length (m) and turn (radians, right positive) of every bend."""
    side = rng.choice([-1.0, 1.0])
    if environment == "wide":
        return [(-BEHIND, length + BEHIND + AHEAD, side * np.radians(rng.uniform(25, 40)))]
    gap, span, low, high = (60.0, 30.0, 12, 25) if environment == "narrow" else (120.0, 50.0, 35, 55)
    bends = []
    for number, start in enumerate(np.arange(gap * 0.5, length + AHEAD, gap)):
        turn = np.radians(rng.uniform(low, high)) * side * (1 if number % 2 else -1)
        bends.append((start + rng.uniform(-0.15, 0.15) * gap, span, turn))
    return bends


def _narrowness(environment: Environment, stations: Stations, rng: np.random.Generator) -> Stations:
    """Sections of about 70 m of either kind where the street is mixed, joined over 12 m."""
    if environment != "mixed":
        return np.full(stations.shape, float(environment == "narrow"))
    section = np.floor((stations - stations[0] + rng.uniform(0, 70.0)) / 70.0).astype(np.int64)
    kernel = np.hanning(round(12.0 / SPACING))
    square = np.pad((section % 2).astype(np.float64), len(kernel), mode="edge")
    return np.convolve(square, kernel / kernel.sum(), mode="same")[len(kernel) : -len(kernel)]
