"""A memory for encoders that can tell from sketches how alike two signatures are at most.

A unit's activity is a maximum over pairs: only those pairs are compared in full that could still raise it.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Int64

from vprbench.types import Responses
from vprbench_localizers.azimuth import agreeing_pairs
from vprbench_localizers.matching import SketchingEncoder
from vprbench_localizers.unit_activity import Rule, View, excite, mean_by_place, products
from vprbench_localizers.unit_memory import UnitMemory, Units

__all__ = ["SketchMemory"]

# Places whose pairs are listed at a time: few enough that lists and sketches stay in the cache.
TOGETHER = 48

# Pairs whose bound is at least so much of their unit's largest are compared at once (our choice), while the unit's
# signature is in the cache; those that are still in doubt then must fetch it again.
LIKELY = np.float32(0.7)


class SketchMemory:
    """Places of units, each with its signature and its sketch; the responses are those of comparing every pair.

    Args:
        encoder: makes and compares both.
    """

    def __init__(self, encoder: SketchingEncoder) -> None:
        self._encoder = encoder
        self._memory, self._sketches = UnitMemory(), UnitMemory()

    def __len__(self) -> int:
        return len(self._memory)

    def add(self, view: View) -> int:
        """Store a place; its index. A place without landmarks has no unit.

        Raises:
            PluginError: its signatures are of another size than those stored.
        """
        index = self._memory.add(view)
        self._sketches.add(self._sketched(view))
        return index

    def respond(self, query: View, rule: Rule) -> Responses:
        """Response 0..1 of every place.

        Raises:
            PluginError: the query's signatures are of another size than those stored.
        """
        if not (self._memory.units and len(query.azimuths)):
            return np.zeros(len(self), np.float32)
        self._memory.require(query)
        sketched, responses = self._sketched(query), np.empty(len(self), np.float32)
        blocks = zip(self._memory.blocks(TOGETHER), self._sketches.blocks(TOGETHER), strict=True)
        for first, (units, sketches) in zip(range(0, len(self), TOGETHER), blocks, strict=True):
            activity = self._activity(query, sketched, units, sketches, rule)
            responses[first : first + TOGETHER] = mean_by_place(activity, units.starts)
        return responses

    def _sketched(self, view: View) -> View:
        return View(self._encoder.sketch(view.signatures), view.azimuths)

    def _activity(
        self, query: View, sketched: View, units: Units, sketches: Units, rule: Rule
    ) -> Float32[np.ndarray, " units"]:
        p, m = agreeing_pairs(query.azimuths, units.azimuths, rule.reach)
        bounds = self._encoder.match_at_most(sketched.signatures, sketches.signatures, p, m)
        most = products(p, m, bounds, query.azimuths, units.azimuths, rule.width, rule.threshold)
        activity, bound = np.zeros((2, len(units.azimuths)), np.float32)
        excite(bound, m, most)
        (likely,) = np.nonzero((most > 0) & (most >= LIKELY * bound[m]))
        self._compare(activity, query, units, p[likely], m[likely], rule)
        most[likely] = 0
        (doubtful,) = np.nonzero(most > activity[m])
        self._compare(activity, query, units, p[doubtful], m[doubtful], rule)
        return activity

    def _compare(
        self,
        activity: Float32[np.ndarray, " units"],
        query: View,
        units: Units,
        p: Int64[np.ndarray, " pairs"],
        m: Int64[np.ndarray, " pairs"],
        rule: Rule,
    ) -> None:
        """Compare pairs in full, and raise the activity of units to their products."""
        matches = self._encoder.match_pairs(query.signatures, units.signatures, p, m)
        excite(activity, m, products(p, m, matches, query.azimuths, units.azimuths, rule.width, rule.threshold))
