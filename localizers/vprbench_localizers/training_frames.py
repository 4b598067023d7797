"""The frames of training drives, for an encoder to learn from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import overload

import numpy as np

from vprbench.types import Frame, Observation

__all__ = ["TrainingFrames"]


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
