"""When places are recruited, against cases worked by hand and the plain loop."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from vprbench.recruiting import Odometer, bisect_vigilance, recruit_by_vigilance


def test_a_place_is_due_each_time_the_step_is_travelled() -> None:
    odometer = Odometer(2.0)
    road = [0.0, 1.0, 2.0, 2.5, 3.9, 4.1, 9.0, 10.0]
    due = [odometer.due(np.array([0.0, x])) for x in road]
    assert due == [True, False, True, False, False, True, True, False]


def test_the_road_counts_not_the_beeline() -> None:
    odometer = Odometer(2.0)
    corner = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
    assert [odometer.due(np.array(point)) for point in corner] == [True, False, True]


@given(st.lists(st.floats(0.1, 3.0), min_size=2, max_size=60), st.floats(0.5, 8.0))
def test_between_two_places_lies_a_step_and_less_than_a_step_and_a_frame(steps: list[float], step: float) -> None:
    road = np.concatenate([[0.0], np.cumsum(steps)])
    odometer = Odometer(step)
    due = [x for x in road if odometer.due(np.array([0.0, x]))]
    gaps = np.diff(due)
    assert (gaps >= step - 1e-9).all()
    assert (gaps < step + max(steps) + 1e-9).all()


def columns(matrix: np.ndarray, vigilance: float) -> list[int]:
    return list(recruit_by_vigilance(lambda k: matrix[:, k], len(matrix), vigilance))


def test_recruits_where_no_place_responds_enough() -> None:
    # Response of the place made at frame k (column) to frame t (row).
    matrix = np.array(
        [[1.0, 0.8, 0.1, 0.0], [0.8, 1.0, 0.6, 0.1], [0.4, 0.6, 1.0, 0.7], [0.0, 0.1, 0.7, 1.0]], np.float32
    )
    assert columns(matrix, 0.0) == [0]
    assert columns(matrix, 0.5) == [0, 2]
    assert columns(matrix, 0.75) == [0, 2, 3]
    assert columns(matrix, 1.1) == [0, 1, 2, 3]


@given(hnp.arrays(np.float32, (8, 8), elements=st.floats(0, 1, width=32)), st.floats(0, 1))
def test_recruiting_is_the_plain_loop(matrix: np.ndarray, vigilance: float) -> None:
    places: list[int] = []
    for t in range(8):
        if not places or max(matrix[t, k] for k in places) < np.float32(vigilance):
            places.append(t)
    assert columns(matrix, vigilance) == places


def test_an_unknown_response_is_no_reason_to_stay() -> None:
    assert columns(np.full((3, 3), np.nan, np.float32), 0.5) == [0, 1, 2]


@pytest.mark.parametrize("target", [1.0, 5.0, 37.0, 49.0])
def test_bisection_reaches_a_count_that_can_be_reached(target: float) -> None:
    vigilance = bisect_vigilance(lambda v: 1 + int(49 * v**3), target)
    assert 1 + int(49 * vigilance**3) == target


def test_bisection_keeps_the_nearest_count_of_a_coarse_one() -> None:
    assert bisect_vigilance(lambda v: 10 if v > 0.3 else 2, 4.0) <= 0.3
    assert bisect_vigilance(lambda v: 10 if v > 0.3 else 2, 7.0) > 0.3
