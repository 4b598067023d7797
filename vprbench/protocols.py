"""What a plug-in can be: an Encoder (frame -> landmarks) or a Localizer (observation -> responses)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal, Protocol, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Float32

from vprbench.types import Frame, Landmarks, Observation, Responses

__all__ = ["DescriptorLocalizer", "Encoder", "Localizer", "Recruiting"]

# Which quantity says when a localizer recruits a new place: a vigilance (0..1) or a step (metres).
Recruiting = Literal["vigilance", "step"]

Description = TypeVar("Description")


@runtime_checkable
class Encoder(Protocol):
    """The what pathway: turns a frame into landmarks, and compares their signatures.

    An encoder may also offer `match_pairs(queries, memory, query_index, memory_index)`, the same matches for listed
    pairs only; a localizer that knows which pairs matter is faster for it.
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
class Localizer(Protocol):
    """The memory: learns places from observations and says how strongly each responds to a new one.

    A localizer that uses an encoder takes it as its constructor argument `encoder`.
    """

    recruiting: ClassVar[Recruiting]

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Train on drives that lie off the evaluated route (`gps` is comparable within one drive only)."""
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
