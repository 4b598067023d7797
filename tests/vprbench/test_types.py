"""What a response vector says, case by case."""

from __future__ import annotations

import numpy as np
import pytest

from vprbench.types import NO_PLACE, Hypothesis, hypothesis

NAN = float("nan")
NOTHING = Hypothesis(NO_PLACE, 0.0)


@pytest.mark.parametrize(
    ("responses", "said"),
    [
        ([], NOTHING),
        ([NAN], NOTHING),
        ([NAN, NAN, NAN], NOTHING),
        ([0.0], NOTHING),
        ([0.0, 0.0], NOTHING),
        ([0.0, NAN], NOTHING),
        ([0.5], Hypothesis(0, 0.5)),
        ([0.25, 0.75, 0.5], Hypothesis(1, 0.75)),
        ([0.25, 0.75, 0.75], Hypothesis(1, 0.75)),
        ([1.0, 1.0], Hypothesis(0, 1.0)),
        ([NAN, 0.25, 0.125], Hypothesis(1, 0.25)),
        ([0.125, NAN, 0.25], Hypothesis(2, 0.25)),
        ([0.0, 1e-30], Hypothesis(1, float(np.float32(1e-30)))),
    ],
)
def test_the_best_response_wins_and_none_is_no_place(responses: list[float], said: Hypothesis) -> None:
    given = np.array(responses, np.float32)
    assert hypothesis(given) == said
    assert np.array_equal(given, np.array(responses, np.float32), equal_nan=True)


def test_a_hypothesis_is_plain_python_whatever_the_responses_are() -> None:
    place, confidence = hypothesis(np.array([0.25, 0.5], np.float32))
    assert (type(place), type(confidence)) == (int, float)
