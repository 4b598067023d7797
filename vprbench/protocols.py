"""What a plug-in can be: an Encoder (frame -> landmarks) or a Localizer (observation -> responses)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal, Protocol, Self, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Float32

from vprbench.types import Frame, Hypothesis, Landmarks, LearningStep, Observation, Responses

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "DescriptorLocalizer",
    "Drawn",
    "Encoder",
    "Localizer",
    "Locating",
    "Measured",
    "Recruiting",
    "Stepwise",
    "Storable",
    "Storing",
]

# Which quantity says when a localizer recruits a new place: a vigilance (0..1) or a step (metres).
Recruiting = Literal["vigilance", "step"]

Description = TypeVar("Description")


@runtime_checkable
class Encoder(Protocol):
    """The what pathway: turns a frame into landmarks, and compares their signatures.

    An encoder may also offer what makes a localizer faster that knows which pairs matter:

    - `match_pairs(queries, memory, query_index, memory_index)`: the same matches, for listed pairs only.
    - `matches_by_sketch`, if it is true: `sketch(signatures)`, and `match_at_most(...)` as `match_pairs` of two such
      sketches, which no match exceeds. Then only pairs that may matter are compared in full.
    - `matches_by_overlap`: whether `match` is 2 sum of shares / (L1(a) + L1(b)), in float32 from the first value to the
      last, where two values share the smaller if both have one sign; and 1 of two rows of zeros. Then a localizer
      matches by itself, and looks only at signatures that have something in common.
    - `matches_bytes`: whether its signatures lie in 0..1, and `match_pairs`, as `sketch` if it matches by sketch, also
      take them as uint8, in 255ths of 1. Then a localizer can keep four times as many.
    """

    def fit(self, frames: Sequence[Frame]) -> None:
        """Learn from frames that lie off the evaluated route; an encoder without learning does nothing."""
        ...

    def encode(self, frame: Frame) -> Landmarks:
        """Find and describe the landmarks of one frame; the same frame always gives the same landmarks."""
        ...

    def match(
        self, queries: Float32[np.ndarray, "points size"], memory: Float32[np.ndarray, "units size"]
    ) -> Float32[np.ndarray, "points units"]:
        """How alike each query signature is to each stored one: 1 for equal, 0 for nothing in common."""
        ...


@runtime_checkable
class Stepwise(Encoder, Protocol):
    """An encoder that learns step by step, so that its progress can be shown."""

    def learning(self, frames: Sequence[Frame]) -> Iterator[LearningStep]:
        """Do what `fit` does, a step at a time; it has learned once the iterator is exhausted."""
        ...


@runtime_checkable
class Storable(Encoder, Protocol):
    """An encoder whose learned state goes to a file and comes back, so that it need be learned only once."""

    def save(self, path: Path) -> None:
        """Write what was learned, with the options it was learned under, to exactly this file."""
        ...

    @classmethod
    def load(cls, path: Path) -> Self:
        """The encoder that was saved: it encodes and matches bit for bit as the one that learned."""
        ...


@runtime_checkable
class Measured(Encoder, Protocol):
    """An encoder that can put what it learned into numbers."""

    def measures(self) -> Mapping[str, float]:
        """Numbers about what was learned, by name; those that end in `_seconds` are wall-clock."""
        ...


@runtime_checkable
class Drawn(Encoder, Protocol):
    """An encoder that can draw what it learned."""

    def figures(self) -> Mapping[str, Figure]:
        """Drawings of what was learned, by the stem of the file to put each in."""
        ...


@runtime_checkable
class Localizer(Protocol):
    """The memory: learns places from observations and says how strongly each responds to a new one.

    A localizer that uses an encoder takes it as its constructor argument `encoder`, keeps it as its attribute
    `encoder`, and finds it fitted: whoever calls `fit` has fitted the encoder before, and the localizer never does.
    """

    recruiting: ClassVar[Recruiting]

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Train what is the localizer's own on drives off the evaluated route.

        `gps` is comparable within one drive only.
        """
        ...

    def clear(self, sampling: float) -> None:
        """Forget every place; from now on recruit at this vigilance (0..1) or step (metres)."""
        ...

    def learn(self, observation: Observation) -> int | None:
        """Recruit this observation as a new place if it is due; the new place's index (0, 1, ...) or None."""
        ...

    def respond(self, observation: Observation) -> Responses:
        """Response 0..1 of every learned place, in the order they were learned."""
        ...


@runtime_checkable
class DescriptorLocalizer(Localizer, Protocol[Description]):
    """A localizer whose places respond independently of each other: each stores one description.

    Then one frame x frame response matrix gives every vigilance and every sampling distance at once, so
    a sweep needs to describe each frame only once. `learn` and `respond` must agree with these two exactly.
    """

    def describe(self, observation: Observation) -> Description:
        """All that a place or a query needs of one observation."""
        ...

    def compare(
        self, queries: Sequence[Description], places: Sequence[Description]
    ) -> Float32[np.ndarray, "queries places"]:
        """Response of a place stored as each of `places` to each of `queries`."""
        ...


@runtime_checkable
class Storing(Localizer, Protocol[Description]):
    """One that can be given places outright, so that a large memory is filled without comparing each with all."""

    def describe(self, observation: Observation) -> Description:
        """All that a place or a query needs of one observation."""
        ...

    def store(self, description: Description) -> int:
        """Make a place of a description, whether or not it is due; its index. `learn` stores what is due."""
        ...


@runtime_checkable
class Locating(Localizer, Protocol):
    """A localizer that finds the place that responds most sooner than it could respond for every place."""

    def locate(self, observation: Observation) -> Hypothesis:
        """Exactly `vprbench.types.hypothesis(respond(observation))`."""
        ...
