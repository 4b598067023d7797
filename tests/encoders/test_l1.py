"""Maps compared only as far as it takes to tell that they differ too much."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vprbench_encoders.l1 import TOGETHER, mean_l1, mean_l1_pairs_within
from vprbench_encoders.log_polar import LogPolar

SIDE = 2 * TOGETHER


def pairs(queries: int, units: int) -> tuple[np.ndarray, np.ndarray]:
    """Every pair, unit by unit."""
    m, p = np.divmod(np.arange(queries * units), queries)
    return p, m


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), limit=st.floats(0.0, 1.0), blend=st.floats(0.0, 1.0))
def test_only_what_lies_beyond_the_limit_may_differ(seed: int, limit: float, blend: float) -> None:
    """Maps that are alike to any degree: blends of noise with one another."""
    rng = np.random.default_rng(seed)
    one, other = rng.random((2, SIDE * SIDE), np.float32)
    queries = np.stack([one, other, np.zeros_like(one)])
    memory = np.stack([np.float32(blend) * one + np.float32(1 - blend) * other, one, np.ones_like(one)])
    p, m = pairs(3, 3)
    found, exact = mean_l1_pairs_within(queries, memory, p, m, limit, SIDE), mean_l1(queries, memory)[p, m]
    within = exact <= limit
    np.testing.assert_array_equal(found[within], exact[within])
    assert (found[~within] > limit).all()


@pytest.mark.parametrize("shift", [0.05, 0.25, 0.5])
def test_at_the_limit_itself_a_pair_is_compared_in_full(shift: float) -> None:
    """Where one map is brighter than the other throughout, the sums differ by as much as the values."""
    query = np.random.default_rng(0).random((1, SIDE * SIDE), np.float32) / 2
    memory, index = query + np.float32(shift), np.zeros(1, np.int64)
    exact = mean_l1(query, memory)[0]
    assert mean_l1_pairs_within(query, memory, index, index, float(exact[0]), SIDE).tolist() == exact.tolist()


def test_sums_spare_comparing_what_is_far_apart() -> None:
    """All values apart by 0.8 but for one: the answer is that of the sums, which is a little less."""
    query, index = np.full((1, SIDE * SIDE), 0.1, np.float32), np.zeros(1, np.int64)
    memory = np.full_like(query, 0.9)
    memory[0, 0] = 0.0
    found = mean_l1_pairs_within(query, memory, index, index, 0.5, SIDE)[0]
    assert found == pytest.approx((0.8 * (SIDE**2 - 1) - 0.1) / SIDE**2, rel=1e-5)
    assert found < mean_l1(query, memory)[0, 0]


@pytest.mark.parametrize("size", [54, 27, 15])
def test_log_polar_matches_above_a_floor_are_those_of_every_pair(size: int) -> None:
    rng = np.random.default_rng(0)
    maps = rng.random((6, size * size), np.float32) * np.linspace(0.1, 1, 6, dtype=np.float32)[:, None]
    encoder, (p, m) = LogPolar(size=size), pairs(6, 6)
    exact = encoder.match_pairs(maps, maps, p, m)
    for floor in (0.0, 0.6, 0.75, 0.99):
        found = encoder.match_pairs_above(maps, maps, p, m, floor)
        np.testing.assert_array_equal(found[exact > floor], exact[exact > floor])
        assert (found[exact <= floor] <= floor).all()
