"""A memory for any encoder: pairs of landmarks whose azimuths agree are listed, and matched by the encoder."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.protocols import Encoder
from vprbench.types import Responses
from vprbench_localizers.azimuth import agreeing_pairs
from vprbench_localizers.matching import pair_matcher
from vprbench_localizers.unit_activity import Rule, View, mean_by_place, product
from vprbench_localizers.unit_memory import UnitMemory

__all__ = ["TOGETHER", "PairMemory"]

# Places whose pairs are listed at a time: few enough that the lists stay in the cache.
TOGETHER = 16


class PairMemory:
    """Places of units that an encoder matches.

    Args:
        encoder: one that also has `match_pairs` (see `PairEncoder`) is faster.
    """

    def __init__(self, encoder: Encoder) -> None:
        self._encoder = encoder
        self._memory = UnitMemory()

    def __len__(self) -> int:
        return len(self._memory)

    def add(self, view: View) -> int:
        """Store a place; its index. A place without landmarks has no unit.

        Raises:
            PluginError: its signatures are of another size than those stored.
        """
        return self._memory.add(view)

    def respond(self, query: View, rule: Rule) -> Responses:
        """Response 0..1 of every place."""
        if not (self._memory.units and len(query.azimuths)):
            return np.zeros(len(self), np.float32)
        matcher = pair_matcher(self._encoder, rule.threshold)
        responses = np.empty(len(self), np.float32)
        for first, units in zip(range(0, len(self), TOGETHER), self._memory.blocks(TOGETHER), strict=True):
            pairs = agreeing_pairs(query.azimuths, units.azimuths, rule.reach)
            matches = matcher(query.signatures, units, *pairs)
            activity = _activity(pairs, matches, query.azimuths, units.azimuths, rule.width, rule.threshold)
            responses[first : first + TOGETHER] = mean_by_place(activity, units.starts)
        return responses


@njit(cache=True)
def _activity(
    pairs: tuple[NDArray[np.int64], NDArray[np.int64]],
    matches: NDArray[np.float32],
    queries: NDArray[np.float32],
    units: NDArray[np.float32],
    width: float,
    threshold: float,
) -> NDArray[np.float32]:
    """Each unit's max over pairs of min(1, max(0, s - RT) / (1 - RT)) * agreement of azimuths."""
    activity = np.zeros(len(units), np.float32)
    scale = np.float32(1) - np.float32(threshold)
    for pair in range(len(matches)):
        recognised = (matches[pair] - np.float32(threshold)) / scale
        if recognised > 0:
            p, m = pairs[0][pair], pairs[1][pair]
            activity[m] = max(activity[m], product(recognised, queries[p], units[m], width))
    return activity
