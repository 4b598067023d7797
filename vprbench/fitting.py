"""Fitting an encoder: every training frame, on one thread, with progress where the encoder tells it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import overload

import numpy as np

from vprbench.protocols import Encoder, Stepwise
from vprbench.reporting import Report, silent
from vprbench.threads import one_thread
from vprbench.types import Frame, LearningStep, Observation

__all__ = ["TrainingFrames", "fit"]


def fit(encoder: Encoder, frames: Sequence[Frame], report: Report = silent) -> None:
    """Let an encoder learn from frames; whatever runs beside it, it learns the same, to the bit."""
    report("fit", 0, 1)
    with one_thread():
        if not isinstance(encoder, Stepwise):
            encoder.fit(frames)
            return
        for step in encoder.learning(frames):
            report("fit", step.done, step.total, _said(step))


def _said(step: LearningStep) -> str:
    """A step in a few words: "S1 120/200, reconstruction rate 0.54"."""
    return f"{step.stage} {step.done}/{step.total}" + (f", {step.note}" if step.note else "")


class TrainingFrames(Sequence[Frame]):
    """The frames of all drives as one sequence, each read when it is asked for."""

    def __init__(self, drives: Sequence[Sequence[Observation]]) -> None:
        self._drives = drives
        self._ends = np.cumsum([0, *map(len, drives)])

    def __len__(self) -> int:
        return int(self._ends[-1])

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        """Frame at an index, or each frame of a slice."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        position = range(len(self))[index]
        drive = int(np.searchsorted(self._ends, position, side="right")) - 1
        return self._drives[drive][position - int(self._ends[drive])]["frame"]
