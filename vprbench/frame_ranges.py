"""Frame numbers as people write them: "392-932" for a run of frames, "00:392-932" for one of a sequence."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["FrameRun", "format_ranges"]

# A day at 10 frames a second, and what six digits hold; a slip of the key must not fill the memory. Our choice.
_LAST = 999_999


def format_ranges(frames: Iterable[int]) -> str:
    """Frame numbers with every run of neighbours written as first-last: "3, 5-8"."""
    runs: list[list[int]] = []
    for frame in sorted(set(frames)):
        if runs and frame == runs[-1][1] + 1:
            runs[-1][1] = frame
        else:
            runs.append([frame, frame])
    return ", ".join(str(first) if first == last else f"{first}-{last}" for first, last in runs)


@dataclass(frozen=True)
class FrameRun:
    """Consecutive frames of one recording, both ends included; written "00:392-932".

    Attributes:
        sequence: the recording's name, for example "00".
        first: number of the first frame, from 0.
        last: number of the last frame, after the first.
    """

    sequence: str
    first: int
    last: int

    @classmethod
    def parse(cls, text: str) -> FrameRun:
        """Read "sequence:first-last"; ValueError where it is not that."""
        match = re.fullmatch(r"([\w.-]+):(\d{1,12})-(\d{1,12})", text, re.ASCII)
        if match is None:
            raise ValueError(f'{text!r} is not "sequence:first-last", for example "00:113-205"')
        run = cls(match[1], int(match[2]), int(match[3]))
        if run.first >= run.last:
            raise ValueError(f"{text!r} ends before it has two frames")
        if run.last > _LAST:
            raise ValueError(f"{text!r} goes on after frame {_LAST}, the last that there can be")
        return run

    def __str__(self) -> str:
        return f"{self.sequence}:{self.first}-{self.last}"

    @property
    def frames(self) -> range:
        """The frame numbers."""
        return range(self.first, self.last + 1)
