from __future__ import annotations

import pytest

from vprbench_encoders.convergence import Fall, Passes


def test_a_fall_is_linear_and_ends_at_zero() -> None:
    fall = Fall(0, 4)
    assert [fall.share(step) for step in range(5)] == [1, 0.75, 0.5, 0.25, 0]


def test_a_shortened_fall_goes_on_from_where_it_is() -> None:
    fall = Fall(0, 100).shortened(20, 4)
    assert (fall.begin, fall.end) == (20, 24)
    assert [fall.share(step) for step in range(20, 25)] == pytest.approx([0.8, 0.6, 0.4, 0.2, 0])


def test_a_fall_is_never_drawn_out() -> None:
    fall = Fall(0, 10).shortened(8, 5)
    assert fall.end == 10
    assert [fall.share(step) for step in (8, 9)] == pytest.approx([0.2, 0.1])
    assert Fall(0, 10).shortened(6, 0).end == 6


def test_a_pass_has_converged_if_its_mean_gains_less_than_the_tolerance() -> None:
    passes = Passes(length=2, tolerance=0.1)
    rates = [0.1, 0.3, 0.4, 0.4, 0.45, 0.45, 0.6, 0.6]
    # Means 0.2, 0.4, 0.45, 0.6: only the third gains too little.
    assert [passes.converged(rate) for rate in rates] == [False] * 5 + [True] + [False] * 2


def test_a_pass_that_is_worse_has_converged() -> None:
    passes = Passes(length=1, tolerance=0.1)
    assert [passes.converged(rate) for rate in (0.5, 0.4)] == [False, True]


def test_without_tolerance_none_converges() -> None:
    passes = Passes(length=1, tolerance=0.0)
    assert not any(passes.converged(rate) for rate in (0.5, 0.4, 0.4))
