"""The next frames of a drive, read on a thread of their own while this one is worked on.

Decoding takes longer than encoding does, and lets go of Python's lock, so that a core that is free can do it; what that
saves is in docs/performance.md.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache

from vprbench.types import Frame

__all__ = ["AHEAD", "ReadAhead"]

# Frames that are read before they are asked for: one would do if all took equally long. Our choice.
AHEAD = 4


class ReadAhead:
    """Frames that are likely to be asked for next: those that follow, once one has followed the one before.

    A frame that cannot be read fails when it is asked for, not before.

    Args:
        read: reads a frame by its number, on any thread.
        count: how many there are.
    """

    def __init__(self, read: Callable[[int], Frame], count: int) -> None:
        self._read, self._count = read, count
        # The frame asked for last; the first of a drive follows none.
        self._last, self._process = -2, 0
        self._coming: dict[int, Future[Frame]] = {}

    def get(self, index: int) -> Frame:
        """Frame `index`, which nobody else gets."""
        process, follows = os.getpid(), index == self._last + 1
        if process != self._process or not follows:
            # What was read for nothing is left to itself: another thread may be waiting for it. So is what was begun
            # before a fork, which threads do not survive.
            self._coming = {}
        self._last, self._process = index, process
        coming = self._coming.pop(index, None)
        if follows:
            for following in range(index + 1, min(index + 1 + AHEAD, self._count)):
                if following not in self._coming:
                    self._coming[following] = _reader(process).submit(self._read, following)
        return self._read(index) if coming is None else coming.result()

    def __reduce__(self) -> tuple[type[ReadAhead], tuple[Callable[[int], Frame], int]]:
        """Copies begin anew: what is being read cannot be copied."""
        return ReadAhead, (self._read, self._count)


@cache
def _reader(process: int) -> ThreadPoolExecutor:
    """The thread that reads ahead for all drives of a process."""
    return ThreadPoolExecutor(1, thread_name_prefix="read-ahead")
