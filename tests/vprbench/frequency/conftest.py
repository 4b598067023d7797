"""Localizers whose times and places are known beforehand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any, ClassVar

import numpy as np
import pytest

from vprbench.frequency.rehearsal import Rehearsal
from vprbench.frequency.subjects import Agent
from vprbench.protocols import Recruiting
from vprbench.types import Frame, Landmarks, Observation, Responses


def work(seconds: float) -> None:
    """Keep the processor busy so long."""
    end = perf_counter() + seconds
    while perf_counter() < end:
        pass


class Clockwork:
    """An encoder that takes so many seconds, and finds one landmark as bright as the frame's first pixel."""

    def __init__(self, seconds: float = 0.0) -> None:
        self.seconds, self.encoded = seconds, 0
        self.nickname = "tick"

    def fit(self, frames: object) -> None: ...

    def encode(self, frame: Frame) -> Landmarks:
        work(self.seconds)
        self.encoded += 1
        return Landmarks(np.array([[frame[0, 0]]], np.float32), np.zeros((1, 2), np.float32))

    def match(self, queries: np.ndarray, memory: np.ndarray) -> np.ndarray:
        return (queries == memory.T).astype(np.float32)


class Pairwise(Clockwork):
    """One that also compares pairs."""

    def match_pairs(self, queries: np.ndarray, memory: np.ndarray, q: np.ndarray, m: np.ndarray) -> np.ndarray:
        return (queries[q] == memory[m]).all(axis=1).astype(np.float32)

    def match_at_most(self, *arguments: Any) -> np.ndarray:  # noqa: ANN401
        return self.match_pairs(*arguments) + np.float32(0.5)


class Ledger:
    """A localizer that remembers what it was shown, and takes so many seconds a place to answer."""

    recruiting: ClassVar[Recruiting] = "vigilance"

    def __init__(self, encoder: Clockwork | Rehearsal, seconds: float = 0.0) -> None:
        self.encoder, self.seconds = encoder, seconds
        self.clear(0.5)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None: ...

    def clear(self, sampling: float) -> None:
        self.vigilance = sampling
        self.places: list[Landmarks] = []
        self.learned: list[Observation] = []

    def learn(self, observation: Observation) -> int | None:
        if max(self.respond(observation), default=0) >= self.vigilance:
            return None
        self.places.append(self.encoder.encode(observation["frame"]))
        self.learned.append(observation)
        return len(self.places) - 1

    def respond(self, observation: Observation) -> Responses:
        seen = self.encoder.encode(observation["frame"]).signatures
        work(self.seconds * len(self.places))
        matches = [self.encoder.match(seen, place.signatures)[0, 0] for place in self.places]
        return np.array(matches, np.float32)


@pytest.fixture
def ledger() -> Callable[..., Agent]:
    """An agent that encodes in so many seconds and compares a place in so many."""

    def make(encode: float = 0.0, compare: float = 0.0, *, pairs: bool = False) -> Agent:
        rehearsal = Rehearsal((Pairwise if pairs else Clockwork)(encode))
        return Agent("ledger", Ledger(rehearsal, compare), rehearsal)

    return make
