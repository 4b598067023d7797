"""A memory for any encoder: pairs of landmarks whose azimuths agree are listed, and matched by the encoder."""

from __future__ import annotations

import numpy as np

from vprbench.protocols import Encoder
from vprbench.types import Responses
from vprbench_localizers.azimuth import agreeing_pairs
from vprbench_localizers.matching import pair_matcher
from vprbench_localizers.unit_activity import Rule, View, excite, mean_by_place, products
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
        """Response 0..1 of every place.

        Raises:
            PluginError: the query's signatures are of another size than those stored.
        """
        if not (self._memory.units and len(query.azimuths)):
            return np.zeros(len(self), np.float32)
        self._memory.require(query)
        matcher = pair_matcher(self._encoder)
        responses = np.empty(len(self), np.float32)
        for first, units in zip(range(0, len(self), TOGETHER), self._memory.blocks(TOGETHER), strict=True):
            p, m = agreeing_pairs(query.azimuths, units.azimuths, rule.reach)
            matches, activity = matcher(query.signatures, units, p, m), np.zeros(len(units.azimuths), np.float32)
            excite(activity, m, products(p, m, matches, query.azimuths, units.azimuths, rule.width, rule.threshold))
            responses[first : first + TOGETHER] = mean_by_place(activity, units.starts)
        return responses
