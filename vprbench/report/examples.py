"""Which answers of a run are worth looking at: some right, those wrong though confident, and the least certain."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from jaxtyping import Int64

from vprbench.trace import Trace
from vprbench.types import NO_PLACE

__all__ = ["pick_examples"]

# How many of each kind, and the metres that lie between two of a kind: neighbouring frames look the same.
_COUNTS = {"right": 2, "wrong, though confident": 3, "least certain": 2}
_APART = 10.0


def pick_examples(trace: Trace) -> Iterator[tuple[str, int]]:
    """Kind and index of each answer to show; fewer where there are fewer, and none twice.

    The right ones are the most confident; "least certain" may be right or wrong.
    """
    answered = trace.hypothesis != NO_PLACE
    surest = np.argsort(-trace.confidence, kind="stable")
    orders = (
        surest[trace.correct[surest]],
        surest[(answered & ~trace.correct)[surest]],
        surest[answered[surest]][::-1],
    )
    taken: set[int] = set()
    for (kind, count), order in zip(_COUNTS.items(), orders, strict=True):
        for index in _spread(trace, (i for i in order.tolist() if i not in taken), count):
            taken.add(index)
            yield kind, index


def _spread(trace: Trace, order: Iterable[int], count: int) -> list[int]:
    """The first of an order that lie apart from each other."""
    chosen: list[int] = []
    for index in order:
        if len(chosen) == count:
            break
        if _clear(trace, index, np.array(chosen, np.int64)):
            chosen.append(index)
    return chosen


def _clear(trace: Trace, index: int, chosen: Int64[np.ndarray, " chosen"]) -> bool:
    """Whether a query lies far enough from those already chosen."""
    gaps = np.hypot(trace.east[chosen] - trace.east[index], trace.north[chosen] - trace.north[index])
    return bool((gaps >= _APART).all())
