"""The truth rules, against cases worked by hand and their definitions."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from vprbench.truth import listed, metric_truth, place_field_truth, ranks, revisit, within

# A straight road with a frame each metre, and three queries beside it.
LEARN = np.array([[0.0, x] for x in range(6)])
TEST = np.array([[0.5, 2.0], [1.5, 3.0], [0.0, 9.0]])


def test_tolerance_is_the_distance_to_the_nearest_learn_frame() -> None:
    visit = revisit(LEARN, TEST)
    assert visit.nearest.tolist() == [2, 3, 5]
    assert visit.tolerance.tolist() == [0.5, 1.5, 4.0]


def test_answers_lie_within_the_tolerance_of_the_nearest_frame() -> None:
    answers = revisit(LEARN, TEST).answers
    assert np.flatnonzero(answers[0]).tolist() == [2]
    assert np.flatnonzero(answers[1]).tolist() == [2, 3, 4]
    assert np.flatnonzero(answers[2]).tolist() == [1, 2, 3, 4, 5]


def test_the_nearest_frame_always_answers() -> None:
    visit = revisit(LEARN, LEARN)
    assert (visit.tolerance == 0).all()
    assert np.array_equal(visit.answers, np.eye(6, dtype=bool))


def test_a_place_is_right_where_it_won_the_record_phase() -> None:
    winners = np.array([0, 0, 1, 1, -1, 2])
    right = place_field_truth(revisit(LEARN, TEST), winners, places=3)
    assert right.tolist() == [[False, True, False], [False, True, False], [True, True, True]]


def test_no_winner_makes_no_place_right() -> None:
    right = place_field_truth(revisit(LEARN, TEST), np.full(6, -1), places=3)
    assert not right.any()


def test_metric_rule_is_half_a_sampling_distance_plus_the_tolerance() -> None:
    visit = revisit(LEARN, TEST)
    # Places at 0, 3 and 5 m; query 0 lies at 2 m, 0.5 m aside, tolerance 0.5 m: right within 1.5 m for d = 2.
    assert metric_truth(visit, np.array([0, 3, 5]), 2.0)[0].tolist() == [False, True, False]
    assert metric_truth(visit, np.array([0, 3, 5]), 4.0)[0].tolist() == [True, True, False]


def test_a_tolerance_of_the_data_sets_own_takes_the_place_of_the_nearest_distance() -> None:
    visit = within(LEARN, np.array([[0.0, 2.0], [0.0, 4.0], [0.0, 9.0]]), 1.0, "frames")
    assert visit.nearest.tolist() == [2, 4, 5]
    assert visit.tolerance.tolist() == [1.0, 1.0, 1.0]
    assert [np.flatnonzero(row).tolist() for row in visit.answers] == [[1, 2, 3], [3, 4, 5], []]
    assert visit.rule == "learn frames within 1 frames of the query; 1 of 3 queries have none"
    assert within(LEARN, LEARN, 1.0, "m").rule == "learn frames within 1 m of the query"
    # Half of 3 and 1 more: 2.5 of the query.
    assert metric_truth(visit, np.array([0, 5]), 3.0).tolist() == [[True, False], [False, True], [False, False]]


def test_a_list_says_what_is_right_without_any_distance() -> None:
    marks = np.zeros((3, 6), bool)
    marks[0, [1, 4]] = marks[2, 5] = True
    visit = listed(LEARN, marks, "the file")
    assert visit.gaps[0].tolist() == [1, 0, 1, 1, 0, 1]
    assert np.isnan(visit.gaps[1]).all()
    assert visit.gaps[2].tolist() == [5, 4, 3, 2, 1, 0]
    assert visit.tolerance.tolist() == [0, 0, 0]
    assert visit.rule == "learn frames that the file lists for the query; 1 of 3 queries have none"
    # By distance a place is right within half of 2 of a listed frame; a query without a list has no right place.
    assert metric_truth(visit, np.array([0, 3]), 2.0).tolist() == [[True, True], [False, False], [False, False]]
    winners = np.array([0, 0, 1, 1, -1, 2])
    assert place_field_truth(visit, winners, places=3).tolist() == [
        [True, False, False],
        [False] * 3,
        [False] * 2 + [True],
    ]
    assert visit.true_places(winners).tolist() == [0, -1, 2]


@given(hnp.arrays(np.int64, 9, elements=st.integers(0, 20)), st.integers(0, 6), st.integers(1, 8))
def test_a_list_of_all_within_a_tolerance_judges_as_the_tolerance_does(
    tests: np.ndarray, tolerance: int, d: int
) -> None:
    road = np.column_stack([np.zeros(21), np.arange(21.0)])
    near = within(road, road[tests], float(tolerance), "frames")
    told = listed(road, near.answers, "the file")
    assert np.array_equal(near.answers, np.abs(np.arange(21)[None] - tests[:, None]) <= tolerance)
    places = np.arange(0, 21, d)
    assert np.array_equal(metric_truth(near, places, float(d)), metric_truth(told, places, float(d)))


def test_rank_counts_the_places_that_respond_more() -> None:
    responses = np.array([[0.1, 0.9, 0.5], [0.5, 0.5, 0.5], [0.0, 0.2, np.nan]], np.float32)
    right = np.array([[True, False, False], [False, False, True], [True, False, True]])
    assert ranks(responses, right).tolist() == [2, 2, -1]


@given(
    hnp.arrays(np.float32, (5, 7), elements=st.floats(0, 1, width=32)),
    hnp.arrays(np.bool_, (5, 7)),
)
def test_rank_is_the_definition(responses: np.ndarray, right: np.ndarray) -> None:
    for row, good, rank in zip(responses, right, ranks(responses, right), strict=True):
        order = sorted(range(7), key=lambda k: (-row[k], k))
        expected = [n for n, k in enumerate(order) if good[k] and row[k] > 0]
        assert rank == (expected[0] if expected else -1)
