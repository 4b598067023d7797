"""What the units of S2 stand for, as pictures: what they look for in C1, traced back through the pooling to S1."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Int64

from vprbench_encoders.sparse_hebbian import unit_length

__all__ = ["cells_combined", "expected_units", "preferred_patterns"]


def preferred_patterns(
    second: Float32[np.ndarray, "units2 cells"], expected: Float32[np.ndarray, "cells size"]
) -> Float32[np.ndarray, "units2 size"]:
    """The local view that each unit of S2 answers to best, of unit length.

    C1 is never negative, and of all such inputs of one strength the unit's positive part excites it most; what it
    wants less of than usual, its negative part, can only be absent. Each cell then stands for its `expected_units`.
    """
    return unit_length(np.maximum(second, 0) @ expected)


def cells_combined(second: Float32[np.ndarray, "units2 cells"]) -> Float32[np.ndarray, " units2"]:
    """How many cells of C1 each unit of S2 looks for at once: 1 / sum of p^2, p being their shares of its energy."""
    energy = np.square(np.maximum(second, 0))
    return np.square(energy.sum(axis=1)) / np.maximum(np.square(energy).sum(axis=1), np.finfo(np.float32).tiny)


def expected_units(
    units: Float32[np.ndarray, "units size"],
    usage: Float32[np.ndarray, " units"],
    cells: Int64[np.ndarray, " units"],
) -> Float32[np.ndarray, "cells size"]:
    """What an active cell of C1 tells of the view: the mean of the units in its window, weighted by their usage.

    The maximum forgets which unit of the window won; this is what it was on average. Where no unit was used, all count.
    """
    share = np.zeros((int(cells.max()) + 1, len(units)), np.float32)
    pooled = np.flatnonzero(cells >= 0)
    share[cells[pooled], pooled] = usage[pooled]
    unused = share.sum(axis=1) == 0
    share[cells[pooled], pooled] += unused[cells[pooled]]
    return (share / share.sum(axis=1, keepdims=True)) @ units
