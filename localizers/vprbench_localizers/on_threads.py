"""The same work on several parts at a time, for kernels that let other threads run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

__all__ = ["on_threads"]

Part = TypeVar("Part")
Done = TypeVar("Done")


def on_threads(work: Callable[[Part], Done], parts: Sequence[Part]) -> list[Done]:
    """What `work` makes of each part, each on a thread of its own; of a single one on the calling thread.

    Threads end with the call, which costs about as much as one place of CoHOG takes: a localizer that kept them could
    neither be copied nor cross to a worker process.
    """
    if len(parts) < 2:
        return [work(part) for part in parts]
    with ThreadPoolExecutor(len(parts)) as pool:
        return list(pool.map(work, parts))
