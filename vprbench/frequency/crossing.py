"""From how many places on one agent answers faster than another."""

from __future__ import annotations

from math import inf

import numpy as np
import pandas as pd
from jaxtyping import Float64

__all__ = ["cheaper_from", "crossing"]


def cheaper_from(table: pd.DataFrame, agent: str, reference: str) -> float:
    """With how many places a query costs the agent as little as the reference, and with more less.

    Between the numbers of places measured, times are taken to grow linearly. 0 if it is cheaper with all of them,
    infinity if it is dearer with the most, or if they have none in common.

    Args:
        table: as `vprbench.frequency.table.as_table` makes it, of one route.
        agent: a name in it.
        reference: another.
    """
    times = table.pivot(index="places", columns="agent", values="query_ms")[[agent, reference]].dropna()
    return crossing(times.index.to_numpy(float), (times[agent] - times[reference]).to_numpy(float))


def crossing(places: Float64[np.ndarray, " sizes"], excess: Float64[np.ndarray, " sizes"]) -> float:
    """Where an excess of time, by places in order, falls to 0 for good; 0 if never above, infinity if it ends so."""
    dearer = np.flatnonzero(excess > 0)
    if not len(places) or excess[-1] > 0:
        return inf
    if not dearer.size:
        return 0.0
    last = dearer[-1]
    return float(np.interp(0.0, -excess[last : last + 2], places[last : last + 2]))
