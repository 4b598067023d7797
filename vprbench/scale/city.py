"""A road through a city, as long as is asked for, whose places are put together from real ones."""

from __future__ import annotations

from itertools import chain, islice
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from vprbench.errors import DataError
from vprbench.frequency.rehearsal import Rehearsal
from vprbench.geodesy import wrap
from vprbench.observation import Drive
from vprbench.reporting import Report, silent
from vprbench.route import Route
from vprbench.types import Landmarks, Observation

__all__ = ["SPACING", "City", "CityPlace", "road_headings"]

# Metres from place to place, and of road between two corners on average (our choice).
SPACING, STREET = 5.0, 100.0

# How much a street bends from place to place, degrees (our choice).
BEND = 1.0

# At most so many frames of a route are taken, those of its learn drive first (our choice).
FRAMES = 300


class CityPlace(NamedTuple):
    """One place of the road.

    Attributes:
        observation: from it.
        landmarks: what is seen there; None where an agent has no encoder, and looks at the frame itself.
    """

    observation: Observation
    landmarks: Landmarks | None


class City:
    """Places of which no two are the same, each made of what a route shows.

    A landmark has the signature of a real one, drawn from all of the route's, at a point where a real frame has one.
    For agents without an encoder a frame is the left of one and the right of another, cut at a random column. The road
    turns at corners by 90 degrees: an agent that looks where the compass says compares more on a straight one.

    Args:
        route: whose frames are taken; they are read at once.
        rehearsal: the encoder that an agent looks through, if any.
        places: of the road.
        seed: of all that is drawn.
        report: is told how many frames are read.

    Raises:
        DataError: the encoder finds nothing in them.
    """

    def __init__(
        self, route: Route, rehearsal: Rehearsal | None, places: int, seed: int = 0, report: Report = silent
    ) -> None:
        drives = chain([route.learn], route.training, [route.test])
        self._frames: list[Observation] = []
        for seen in islice(chain.from_iterable(map(Drive, drives)), FRAMES):
            self._frames.append(seen)
            report("read frames", len(self._frames), FRAMES)
        self._landmarks = [rehearsal.encode(seen["frame"]) for seen in self._frames] if rehearsal else []
        self._signatures = np.concatenate([found.signatures for found in self._landmarks] or [np.empty((0, 0))])
        if rehearsal and not len(self._signatures):
            raise DataError(f"{route.name}: the encoder finds no landmarks, of which a city could be made")
        self._seed, self.headings = seed, road_headings(places, seed)

    def __getitem__(self, index: int) -> CityPlace:
        """A place of the road; the same however often it is asked for."""
        rng = np.random.default_rng([self._seed, index])
        one, other = rng.integers(0, len(self._frames), 2)
        frame = self._frames[one]["frame"].copy()
        cut = rng.integers(1, frame.shape[1])
        frame[:, cut:] = self._frames[other]["frame"][:, cut:]
        observation = Observation(
            frame=frame,
            heading=self.headings[[index]],
            camera=self._frames[one]["camera"],
            gps=np.array([0.0, SPACING * index]),
        )
        return CityPlace(observation, self._recombined(one, rng) if self._landmarks else None)

    def query(self, observation: Observation, number: int) -> Observation:
        """An observation as if made where the road has a heading that one of its places has."""
        rng = np.random.default_rng([self._seed, len(self.headings), number])
        return Observation(**{**observation, "heading": rng.choice(self.headings, 1)})

    def _recombined(self, one: int, rng: np.random.Generator) -> Landmarks:
        points = self._landmarks[one].points
        return Landmarks(self._signatures[rng.integers(0, len(self._signatures), len(points))], points)


def road_headings(places: int, seed: int) -> Float64[np.ndarray, " places"]:
    """Headings along a road that bends a little and turns left or right at corners, -pi..pi."""
    rng = np.random.default_rng(seed)
    corners = (rng.random(places) < SPACING / STREET) * rng.choice([-np.pi / 2, np.pi / 2], places)
    return wrap(np.cumsum(corners + rng.normal(0, np.radians(BEND), places)))
