"""What the checks of an encoder work on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import overload

import numpy as np
from numpy.typing import NDArray

from vprbench.checks.samples import textured_frame, training_frames
from vprbench.protocols import Encoder
from vprbench.types import Frame, Landmarks

__all__ = ["EncoderSubject", "LazyFrames", "same_landmarks"]


class EncoderSubject:
    """The encoder under test, fitted when first needed, and what it makes of two frames."""

    def __init__(self, factory: Callable[[], Encoder]) -> None:
        self.factory = factory

    @cached_property
    def encoder(self) -> Encoder:
        """One that is fitted, for all checks that only use it."""
        return self.fit(training_frames())

    @cached_property
    def landmarks(self) -> list[Landmarks]:
        """Those of the frames 1 and 2."""
        return [self.encoder.encode(textured_frame(seed)) for seed in (1, 2)]

    @property
    def signatures(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Those of the two frames, copied: what a match writes into them, no other check sees."""
        one, other = self.landmarks
        return one.signatures.copy(), other.signatures.copy()

    def fit(self, frames: Sequence[Frame]) -> Encoder:
        """A new encoder that has learned from these frames."""
        encoder = self.factory()
        encoder.fit(frames)
        return encoder


class LazyFrames(Sequence[Frame]):
    """Frames that are a sequence, but no list: as real drives are, which read each frame when asked."""

    def __len__(self) -> int:
        return len(training_frames())

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        return training_frames()[index]


def same_landmarks(one: Landmarks, other: Landmarks) -> bool:
    """Whether two sets of landmarks are equal to the bit."""
    return np.array_equal(one.signatures, other.signatures) and np.array_equal(one.points, other.points)
