"""The curve and its scores against scikit-learn, pair counting, and a case worked by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from sklearn import metrics as sk

from vprbench.errors import DataError
from vprbench.precision_recall import (
    CURVE_METRICS,
    accuracy,
    curve,
    extended_precision,
    pr_auc,
    pr_auc_all,
    recall_at_100_precision,
    recall_at_100_precision_all,
    roc_auc,
    tally,
)

# Surest first: right, wrong, right, then a right and a wrong one of equal confidence, then a query without a match.
CORRECT = np.array([True, False, True, True, False, False])
CONFIDENCE = np.array([0.9, 0.8, 0.7, 0.6, 0.6, 0.0])

Answers = tuple[np.ndarray, np.ndarray]


@st.composite
def answers(draw: st.DrawFn) -> Answers:
    """Right or wrong, and confidences of which many are equal."""
    pairs = draw(st.lists(st.tuples(st.booleans(), st.integers(0, 6)), min_size=1, max_size=40))
    correct, level = zip(*pairs, strict=True)
    return np.array(correct), np.array(level) / 7


def scores(correct: np.ndarray, confidence: np.ndarray, weights: np.ndarray | None = None) -> dict[str, float]:
    counts = tally(correct, confidence, weights)
    return {name: float(metric(counts)[0]) for name, metric in CURVE_METRICS.items()}


def test_hand_worked_case() -> None:
    counts = tally(CORRECT, CONFIDENCE)
    assert counts.right.tolist() == [[1, 1, 2, 3, 3]]
    assert counts.passed.tolist() == [[1, 2, 3, 5, 6]]
    # Trapezoids 1/3 * 1, 1/3 * (1/2 + 2/3)/2 and 1/3 * (2/3 + 3/5)/2.
    assert pr_auc(counts)[0] == pytest.approx(133 / 180)
    assert pr_auc_all(counts)[0] == pytest.approx(133 / 360)
    assert accuracy(counts)[0] == pytest.approx(1 / 2)
    assert recall_at_100_precision(counts)[0] == pytest.approx(1 / 3)
    assert recall_at_100_precision_all(counts)[0] == pytest.approx(1 / 6)
    assert extended_precision(counts)[0] == pytest.approx((1 + 1 / 3) / 2)
    # Of the nine pairs of a right and a wrong answer six are in order and one is tied.
    assert roc_auc(counts)[0] == pytest.approx(6.5 / 9)


def test_hand_worked_curve() -> None:
    drawn = curve(CORRECT, CONFIDENCE)
    assert drawn.thresholds.tolist() == [np.inf, 0.9, 0.8, 0.7, 0.6, 0.0]
    assert drawn.precision.tolist() == pytest.approx([1, 1, 1 / 2, 2 / 3, 3 / 5, 1 / 2])
    assert drawn.recall.tolist() == pytest.approx([0, 1 / 3, 1 / 3, 2 / 3, 1, 1])


def test_all_right_all_wrong() -> None:
    right = scores(np.ones(4, bool), np.linspace(0.1, 1, 4))
    assert all(value == 1.0 for name, value in right.items() if name != "roc_auc")
    wrong = scores(np.zeros(4, bool), np.linspace(0.1, 1, 4))
    assert all(value == 0.0 for name, value in wrong.items() if name != "roc_auc")
    assert np.isnan(right["roc_auc"])
    assert np.isnan(wrong["roc_auc"])


def test_the_surest_answer_is_wrong() -> None:
    got = scores(np.array([False, True, True]), np.array([0.9, 0.5, 0.4]))
    assert got["recall_at_100_precision"] == 0.0
    assert got["extended_precision"] == 0.0
    # (0, 0) -> (1/2, 1/2) -> (1, 2/3): nothing is gained from the opening point at precision 1.
    assert got["auc"] == pytest.approx((1 / 2 * 1 / 2 + 1 / 2 * (1 / 2 + 2 / 3)) / 2)


@given(answers())
def test_scikit_learn_agrees(given_answers: Answers) -> None:
    correct, confidence = given_answers
    assume(correct.any())
    precision, recall, thresholds = sk.precision_recall_curve(correct, confidence)
    ours = curve(correct, confidence)
    np.testing.assert_allclose(ours.precision[::-1], precision, atol=1e-12)
    np.testing.assert_allclose(ours.recall[::-1], recall, atol=1e-12)
    np.testing.assert_array_equal(ours.thresholds[:0:-1], thresholds)
    got = scores(correct, confidence)
    assert got["auc"] == pytest.approx(sk.auc(recall, precision), abs=1e-12)
    assert got["extended_precision"] == pytest.approx((precision[-2] + recall_at_one(precision, recall)) / 2)
    if not correct.all():
        assert got["roc_auc"] == pytest.approx(sk.roc_auc_score(correct, confidence), abs=1e-12)


def recall_at_one(precision: np.ndarray, recall: np.ndarray) -> float:
    """The largest recall at precision 1, which the opening point makes 0 at least."""
    return float(recall[precision == 1].max())


@given(answers())
def test_auc_over_all_queries_is_auc_times_accuracy(given_answers: Answers) -> None:
    got = scores(*given_answers)
    assert got["auc_all"] == pytest.approx(got["auc"] * got["accuracy"], abs=1e-12)


@given(answers())
def test_recall_at_100_precision_counts_what_beats_every_wrong_answer(given_answers: Answers) -> None:
    correct, confidence = given_answers
    beaten = confidence[~correct].max(initial=-1.0)
    share = (correct & (confidence > beaten)).sum()
    got = scores(correct, confidence)
    assert got["recall_at_100_precision_all"] == pytest.approx(share / len(correct))
    assert got["recall_at_100_precision"] == pytest.approx(share / max(correct.sum(), 1))


@given(answers(), st.data())
def test_a_monotone_transform_of_confidence_changes_nothing(given_answers: Answers, data: st.DataObject) -> None:
    correct, confidence = given_answers
    levels, inverse = np.unique(confidence, return_inverse=True)
    values = st.floats(-1e9, 1e9, allow_nan=False)
    new = sorted(data.draw(st.sets(values, min_size=len(levels), max_size=len(levels))))
    np.testing.assert_equal(scores(correct, np.array(new)[inverse]), scores(correct, confidence))


@given(answers(), st.data())
def test_the_order_of_queries_changes_nothing(given_answers: Answers, data: st.DataObject) -> None:
    correct, confidence = given_answers
    order = np.array(data.draw(st.permutations(range(len(correct)))))
    np.testing.assert_equal(scores(correct[order], confidence[order]), scores(correct, confidence))


@given(answers(), st.data())
def test_weights_are_repetitions(given_answers: Answers, data: st.DataObject) -> None:
    correct, confidence = given_answers
    size = len(correct)
    weights = np.array(data.draw(st.lists(st.integers(0, 3), min_size=size, max_size=size)))
    assume(weights.any())
    repeated = scores(np.repeat(correct, weights), np.repeat(confidence, weights))
    np.testing.assert_equal(scores(correct, confidence, weights[None]), repeated)


@given(answers())
def test_weights_of_one_are_no_weights(given_answers: Answers) -> None:
    ones = np.ones((1, len(given_answers[0])), np.int64)
    np.testing.assert_equal(scores(*given_answers, ones), scores(*given_answers))


def test_rows_of_weights_are_independent() -> None:
    weights = np.array([[1, 1, 1, 1, 1, 1], [0, 2, 0, 1, 3, 0], [6, 0, 0, 0, 0, 0]])
    together = tally(CORRECT, CONFIDENCE, weights)
    for row, metric in ((row, metric) for row in range(3) for metric in CURVE_METRICS.values()):
        alone = metric(tally(CORRECT, CONFIDENCE, weights[row : row + 1]))[0]
        np.testing.assert_equal(metric(together)[row], alone)


@pytest.mark.parametrize(
    ("correct", "confidence"),
    [
        (np.array([True]), np.array([np.nan])),
        (np.array([True]), np.array([0.1, 0.2])),
        (np.array([], bool), np.array([])),
    ],
)
def test_what_cannot_be_scored_is_refused(correct: np.ndarray, confidence: np.ndarray) -> None:
    with pytest.raises(DataError, match="cannot score"):
        tally(correct, confidence)
