"""An encoder that can be told what to answer, so that what a localizer does besides encoding can be timed by itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np
from jaxtyping import Float32

from vprbench.protocols import Encoder
from vprbench.types import Frame, Landmarks

__all__ = ["Rehearsal"]

# Methods that an encoder may have beside `match`: pairs of rows by their indices, the third and fourth argument.
_PAIRWISE = "match_pairs", "match_at_most"


class Rehearsal:
    """An encoder in front of another, fitted one, of which it has every method and attribute.

    Args:
        encoder: that answers, unless it is told otherwise.
    """

    def __init__(self, encoder: Encoder) -> None:
        self.encoder = encoder
        self._recalled: Landmarks | None = None
        self._blank = False
        for name in _PAIRWISE:
            # Only what has the method is taken for an encoder that compares pairs so.
            if hasattr(encoder, name):
                setattr(self, name, partial(self._match_pairs, name))

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - whatever the other has
        return getattr(self.__dict__["encoder"], name)

    def __deepcopy__(self, memo: dict[int, Any]) -> Rehearsal:
        """Itself: localizers that are copied go on looking through one encoder."""
        return self

    def fit(self, frames: Sequence[Frame]) -> None:
        """Let the other learn."""
        self.encoder.fit(frames)

    def encode(self, frame: Frame) -> Landmarks:
        """What is recalled, if anything is; else what the other finds."""
        return self.encoder.encode(frame) if self._recalled is None else self._recalled

    def match(
        self, queries: Float32[np.ndarray, "points size"], memory: Float32[np.ndarray, "units size"]
    ) -> Float32[np.ndarray, "points units"]:
        """What the other answers; 0 throughout where nothing is to have anything in common."""
        if self._blank:
            return np.zeros((len(queries), len(memory)), np.float32)
        return self.encoder.match(queries, memory)

    def _match_pairs(self, name: str, *pairs: Any) -> Float32[np.ndarray, " pairs"]:  # noqa: ANN401
        if self._blank:
            return np.zeros(len(pairs[2]), np.float32)
        return getattr(self.encoder, name)(*pairs)

    @contextmanager
    def recalling(self, landmarks: Landmarks, *, blank: bool = False) -> Iterator[None]:
        """While entered, every frame has these landmarks, and if blank, no two landmarks have anything in common.

        Blank, a localizer takes every frame for a new place, and spends no time on comparing it with the others.
        """
        self._recalled, self._blank = landmarks, blank
        try:
            yield
        finally:
            self._recalled, self._blank = None, False
