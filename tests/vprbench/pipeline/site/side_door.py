"""Localizers that know the truth, or nothing: what each must score is known without playing it.

The side door: they load the route themselves and know each frame by its bytes.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from hashlib import blake2b
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from vprbench.catalogue import load_route
from vprbench.protocols import Recruiting
from vprbench.recruiting import Odometer
from vprbench.types import Frame, Observation, Responses


class Seen(NamedTuple):
    """Where a frame was taken: which drive, how far north, and at which position the learn drive comes nearest."""

    is_test: bool
    north: float
    nearest: tuple[float, float]


def digest(frame: Frame) -> bytes:
    return blake2b(frame.tobytes(), digest_size=16).digest()


@cache
def truth(route: str, routes: str) -> dict[bytes, Seen]:
    """Every frame of a route, by its bytes."""
    loaded, known = load_route(route, routes=routes), dict[bytes, Seen]()
    memories = [(float(east), float(north)) for east, north in loaded.learn.positions]
    for drive in (loaded.learn, loaded.test):
        for index, (east, north) in enumerate(drive.positions):
            nearest = min(memories, key=lambda memory: (memory[0] - east) ** 2 + (memory[1] - north) ** 2)
            known[digest(drive.frames[index])] = Seen(drive is loaded.test, float(north), nearest)
    return known


class Cheat:
    """The place nearest to where the learn drive came nearest; a place at every step of road."""

    recruiting: ClassVar[Recruiting] = "step"

    def __init__(self, route: str, routes: str) -> None:
        self.known = truth(route, routes)
        self.clear(1.0)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Nothing to learn."""

    def clear(self, sampling: float) -> None:
        self.odometer = Odometer(sampling)
        self.places: list[Seen] = []

    def learn(self, observation: Observation) -> int | None:
        if not self.is_due(observation):
            return None
        self.places.append(self.see(observation))
        return len(self.places) - 1

    def is_due(self, observation: Observation) -> bool:
        return self.odometer.due(observation["gps"])

    def respond(self, observation: Observation) -> Responses:
        return self.answer(self.see(observation))

    def see(self, observation: Observation) -> Seen:
        return self.known[digest(observation["frame"])]

    def answer(self, seen: Seen) -> Responses:
        """A response that falls with the distance."""
        away = [np.hypot(*np.subtract(place.nearest, seen.nearest)) for place in self.places]
        return np.float32(1) / (1 + np.array(away, np.float32))

    def only(self, place: int, confidence: float) -> Responses:
        """This place and no other."""
        return np.eye(len(self.places), dtype=np.float32)[place] * np.float32(confidence)


class PerfectMemory(Cheat):
    """A place at every frame, each of which responds to its own frame alone."""

    def is_due(self, observation: Observation) -> bool:
        return True

    def answer(self, seen: Seen) -> Responses:
        return self.only([place.nearest for place in self.places].index(seen.nearest), 1.0)


class CheatByMatrix(Cheat):
    """The same, recruited by vigilance and read from the response matrix."""

    recruiting: ClassVar[Recruiting] = "vigilance"

    def __init__(self, route: str, routes: str) -> None:
        super().__init__(route, routes)

    def clear(self, sampling: float) -> None:
        self.vigilance = np.float32(sampling)
        self.places = []

    def is_due(self, observation: Observation) -> bool:
        return not self.places or bool(self.respond(observation).max() < self.vigilance)

    def describe(self, observation: Observation) -> Seen:
        return self.see(observation)

    def compare(self, queries: Sequence[Seen], places: Sequence[Seen]) -> np.ndarray:
        self.places = list(places)
        return np.array([self.answer(query) for query in queries], np.float32).reshape(len(queries), len(places))


class OnePlace(Cheat):
    """Place 0 at every test frame; the truth in the record phase, or place 0 there too."""

    def __init__(self, route: str, routes: str, recorded: Literal["truth", "same"]) -> None:
        super().__init__(route, routes)
        self.recorded = recorded

    def answer(self, seen: Seen) -> Responses:
        return self.only(0, 0.5) if seen.is_test or self.recorded == "same" else super().answer(seen)


class Guess(CheatByMatrix):
    """Random responses at every test frame; the truth in the record phase, or random ones there too."""

    recruiting: ClassVar[Recruiting] = "step"

    def __init__(self, route: str, routes: str, recorded: Literal["truth", "same"], seed: int) -> None:
        super().__init__(route, routes)
        self.recorded, self.rng = recorded, np.random.default_rng(seed)

    def answer(self, seen: Seen) -> Responses:
        if seen.is_test or self.recorded == "same":
            return 1 - self.rng.random(len(self.places), np.float32)
        return super().answer(seen)


class Lapse(Cheat):
    """The truth, but on one stretch of the test drive the place that is farthest.

    Args:
        route: name of the route.
        routes: the file that has it.
        start: of the stretch, metres north.
        stop: of it.
        confidence: the same everywhere, lower where it is wrong, or random.
        seed: of the random confidence.
    """

    def __init__(
        self,
        route: str,
        routes: str,
        start: float,
        stop: float,
        confidence: Literal["constant", "honest", "random"],
        seed: int = 0,
    ) -> None:
        super().__init__(route, routes)
        self.start, self.stop, self.confidence = start, stop, confidence
        self.rng = np.random.default_rng(seed)

    def answer(self, seen: Seen) -> Responses:
        true = super().answer(seen)
        wrong = seen.is_test and self.start <= seen.north < self.stop
        sure = {"constant": 0.5, "honest": 0.2 if wrong else 0.8, "random": 1 - self.rng.random()}
        return self.only(int(true.argmin() if wrong else true.argmax()), sure[self.confidence])


class Peek(Cheat):
    """Looks for the GPS that record and test withhold."""

    def respond(self, observation: Observation) -> Responses:
        return self.only(0, float(observation["gps"][0] > 0))


class PeekByMatrix(CheatByMatrix):
    """The same through the response matrix."""

    def describe(self, observation: Observation) -> Seen:
        return Seen(False, float(observation["gps"][1]), (0.0, 0.0))


class Pixels:
    """An honest localizer in whole numbers: one less the share of grey levels by which two frames differ."""

    recruiting: ClassVar[Recruiting] = "step"

    def __init__(self) -> None:
        self.clear(1.0)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Nothing to learn."""

    def clear(self, sampling: float) -> None:
        self.odometer = Odometer(sampling)
        self.places: list[np.ndarray] = []

    def learn(self, observation: Observation) -> int | None:
        if not self.odometer.due(observation["gps"]):
            return None
        self.places.append(self.describe(observation))
        return len(self.places) - 1

    def respond(self, observation: Observation) -> Responses:
        return self.compare([self.describe(observation)], self.places)[0]

    def describe(self, observation: Observation) -> np.ndarray:
        return observation["frame"][2::8, 3::6].astype(np.int64).ravel()

    def compare(self, queries: Sequence[np.ndarray], places: Sequence[np.ndarray]) -> np.ndarray:
        memory = np.stack(places)
        away = np.array([np.abs(memory - query).sum(axis=1) for query in queries])
        return (1 - away / (255 * memory.shape[1])).astype(np.float32)
