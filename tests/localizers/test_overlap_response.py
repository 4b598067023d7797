"""Chosen places respond bit by bit as they do among all, whichever are chosen."""

from __future__ import annotations

from math import inf, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vprbench_localizers.overlap_memory import OverlapMemory
from vprbench_localizers.overlap_response import overlap_responses
from vprbench_localizers.sparse_views import SparseViews
from vprbench_localizers.unit_activity import Rule, View


def views(seed: int, count: int, *, signed: bool) -> list[View]:
    """Places of up to 6 landmarks, some of none, with codes of up to 5 of 12 values, some of none."""
    rng = np.random.default_rng(seed)
    made = []
    for n in rng.integers(0, 7, count):
        codes = (
            rng.uniform(-3 if signed else 0.1, 3, (n, 12)) * (rng.random((n, 12)) < 0.4) * rng.integers(0, 2, (n, 1))
        )
        made.append(View(codes.astype(np.float32), rng.uniform(-pi, pi, n).astype(np.float32)))
    return made


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    signed=st.booleans(),
    threshold=st.floats(0.0, 0.9),
    width=st.sampled_from([0.01, 0.1, 1.0, 4.0, inf]),
    chosen=st.lists(st.integers(0, 19), max_size=20),
)
def test_they_are_those_of_the_memory_of_all_places(
    seed: int, signed: bool, threshold: float, width: float, chosen: list[int]
) -> None:
    places, kept, memory = views(seed, 20, signed=signed), SparseViews(), OverlapMemory()
    for place in places:
        assert kept.add(place) == memory.add(place)
    rule, asked = Rule(threshold, width, 3 * width), np.array(chosen, np.int64)
    for query in [*views(seed + 1, 3, signed=signed), *places[:3]]:
        told = overlap_responses(query, kept.units, asked, rule)
        np.testing.assert_array_equal(told, memory.respond(query, rule)[asked])


def test_a_response_worked_by_hand() -> None:
    """Codes (3, 1) and (1, 1) share 2 of 6: a match of 2/3, a third above the threshold of 1/2."""
    kept, ahead = SparseViews(), np.zeros(1, np.float32)
    kept.add(View(np.array([[9, 9]], np.float32), ahead))
    kept.add(View(np.array([[1, 1], [0, 0]], np.float32), np.array([0.1, 0.1], np.float32)))
    query = View(np.array([[3, 1]], np.float32), ahead)
    told = overlap_responses(query, kept.units, np.array([1]), Rule(0.5, 0.1, 0.3))
    assert told == pytest.approx([(1 / 3 * np.exp(-0.5) + 0) / 2])
