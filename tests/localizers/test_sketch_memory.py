"""A memory that compares in full only what sketches leave in doubt answers as one that compares every pair."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from vprbench.errors import PluginError
from vprbench.types import Frame, Landmarks
from vprbench_localizers.memory import memory_for
from vprbench_localizers.pair_memory import PairMemory
from vprbench_localizers.sketch_memory import TOGETHER, SketchMemory
from vprbench_localizers.unit_activity import Rule, View

Rows = NDArray[np.float32]
Indices = NDArray[np.int64]


class Sketching:
    """An encoder of rows of eight values, whose sketches are their first few; it counts what it compares in full."""

    matches_by_sketch = True

    def __init__(self, kept: int) -> None:
        self.kept, self.compared = kept, 0

    def fit(self, frames: object) -> None: ...

    def encode(self, frame: Frame) -> Landmarks:
        raise NotImplementedError

    def match(self, queries: Rows, memory: Rows) -> Rows:
        return np.float32(1) - np.abs(queries[:, None] - memory[None]).mean(axis=2)

    def match_pairs(self, queries: Rows, memory: Rows, p: Indices, m: Indices) -> Rows:
        self.compared += len(p)
        return np.float32(1) - np.abs(queries[p] - memory[m]).mean(axis=1)

    def sketch(self, signatures: Rows) -> Rows:
        return signatures[:, : self.kept].copy()

    def match_at_most(self, queries: Rows, memory: Rows, p: Indices, m: Indices) -> Rows:
        return np.float32(1 + 1e-6) - np.abs(queries[p] - memory[m]).sum(axis=1) / np.float32(8)


def views(seed: int, count: int) -> list[View]:
    rng = np.random.default_rng(seed)
    base = rng.random((6, 8))
    made = []
    for n in rng.integers(0, 8, count):
        signatures = base[rng.integers(0, 6, n)] + rng.normal(0, 0.1, (n, 8))
        made.append(View(signatures.clip(0, 1).astype(np.float32), rng.uniform(-pi, pi, n).astype(np.float32)))
    return made


@settings(max_examples=30, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    kept=st.integers(0, 8),
    threshold=st.floats(0.0, 0.95),
    width=st.sampled_from([0.1, 1.0, np.inf]),
)
def test_it_answers_bitwise_as_comparing_every_pair_does(seed: int, kept: int, threshold: float, width: float) -> None:
    encoder, rule = Sketching(kept), Rule(threshold, width, 3 * width)
    sketched, plain = SketchMemory(encoder), PairMemory(encoder)
    for index, place in enumerate(views(seed, TOGETHER + 3)):
        assert sketched.add(place) == plain.add(place) == index
    for query in views(seed + 1, 3):
        np.testing.assert_array_equal(sketched.respond(query, rule), plain.respond(query, rule))


def test_better_sketches_leave_less_to_compare() -> None:
    rule, query, compared = Rule(0.7, 1.0, 3.0), views(1, 9)[5], []
    assert len(query.azimuths) > 3
    for kept in (0, 4, 8):
        encoder = Sketching(kept)
        memory = SketchMemory(encoder)
        for place in views(0, 60):
            memory.add(place)
        assert memory.respond(query, rule).max() > 0
        compared.append(encoder.compared)
    assert compared[0] > compared[1] > compared[2]


def test_it_is_the_memory_of_encoders_that_say_so() -> None:
    encoder = Sketching(4)
    assert isinstance(memory_for(encoder)._make(), SketchMemory)
    encoder.matches_by_sketch = False
    assert isinstance(memory_for(encoder)._make(), PairMemory)


def test_signatures_of_two_sizes_are_refused() -> None:
    wide = View(np.ones((1, 4), np.float32), np.zeros(1, np.float32))
    for memory in SketchMemory(Sketching(2)), PairMemory(Sketching(2)):
        memory.add(View(np.ones((1, 3), np.float32), np.zeros(1, np.float32)))
        for use in memory.add, lambda view, memory=memory: memory.respond(view, Rule(0.0, 1.0, 1.0)):
            with pytest.raises(PluginError, match="signatures of 4 values, the places stored have 3"):
                use(wide)
