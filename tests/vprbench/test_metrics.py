"""The row of metrics of a trace, worked by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.metrics import METRICS, RECALL_DEPTHS, evaluate, recall_at
from vprbench.trace import Trace

NONE = float("nan")

# Five queries: right, wrong by the place fields only, wrong by both rules, no match, right.
TRACE = Trace(
    frame=np.arange(10, 15),
    truth=np.array([0, 1, 2, 3, 4]),
    hypothesis=np.array([0, 0, 9, -1, 4]),
    confidence=np.array([0.9, 0.8, 0.5, 0.0, 0.7]),
    error_m=np.array([0.5, 2.0, 30.0, NONE, 1.5]),
    tolerance_m=np.full(5, 0.5),
    correct=np.array([True, False, False, False, True]),
    correct_metric=np.array([True, True, False, False, True]),
    rank=np.array([0, 3, 12, -1, 0]),
    rank_metric=np.array([0, 0, 7, -1, 0]),
    east=np.arange(5.0),
    north=np.zeros(5),
)


def test_the_columns_are_the_metrics_in_order() -> None:
    assert tuple(evaluate(TRACE)) == METRICS
    assert len(set(METRICS)) == len(METRICS)


def test_place_field_rule() -> None:
    row = evaluate(TRACE)
    # Right at 0.9, wrong at 0.8, right at 0.7: 1/2 * 1 + 1/2 * (1/2 + 2/3)/2.
    assert row["auc"] == pytest.approx(1 / 2 + 7 / 24)
    assert row["auc_all"] == pytest.approx((1 / 2 + 7 / 24) * 2 / 5)
    assert row["accuracy"] == pytest.approx(2 / 5)
    assert [row[f"recall_at_{depth}"] for depth in (1, 5, 10, 20)] == pytest.approx([2 / 5, 3 / 5, 3 / 5, 4 / 5])
    assert row["recall_at_100_precision"] == pytest.approx(1 / 2)
    assert row["recall_at_100_precision_all"] == pytest.approx(1 / 5)
    assert row["extended_precision"] == pytest.approx(3 / 4)
    # 0.9 beats all three wrong answers, 0.7 beats 0.5 and 0.
    assert row["roc_auc"] == pytest.approx(5 / 6)


def test_metric_rule() -> None:
    row = evaluate(TRACE)
    assert row["auc_metric"] == 1.0
    assert row["auc_all_metric"] == pytest.approx(3 / 5)
    assert row["accuracy_metric"] == pytest.approx(3 / 5)
    assert [row[f"recall_at_{depth}_metric"] for depth in (1, 5, 10)] == pytest.approx([3 / 5, 3 / 5, 4 / 5])
    assert row["recall_at_100_precision_metric"] == 1.0
    assert row["extended_precision_metric"] == 1.0
    assert row["roc_auc_metric"] == 1.0


def test_errors_are_over_the_queries_with_a_hypothesis() -> None:
    row = evaluate(TRACE)
    assert row["error_mean_m"] == pytest.approx(34 / 4)
    assert row["error_median_m"] == pytest.approx(1.75)
    assert row["no_match"] == pytest.approx(1 / 5)


def test_without_any_hypothesis_there_is_no_error() -> None:
    frame = TRACE.to_frame().assign(
        hypothesis=-1, confidence=0.0, error_m=NONE, correct=False, correct_metric=False, rank=-1, rank_metric=-1
    )
    row = evaluate(Trace.from_frame(frame))
    assert np.isnan(row["error_mean_m"])
    assert np.isnan(row["error_median_m"])
    assert row["no_match"] == 1.0
    assert row["auc"] == row["auc_all"] == row["accuracy"] == row["recall_at_20"] == 0.0


def test_recall_at_one_is_the_accuracy() -> None:
    row = evaluate(TRACE)
    assert row["recall_at_1"] == row["accuracy"]
    assert row["recall_at_1_metric"] == row["accuracy_metric"]


def test_the_rank_counts_from_zero() -> None:
    assert recall_at(np.array([0, 4, 5, -1]), 5) == 2 / 4


@given(st.lists(st.integers(-1, 30), min_size=1))
def test_recall_grows_with_depth_to_the_share_that_has_a_right_place(ranks: list[int]) -> None:
    recalls = [recall_at(np.array(ranks), depth) for depth in (*RECALL_DEPTHS, 31)]
    assert recalls == sorted(recalls)
    assert recalls[-1] == pytest.approx(sum(rank >= 0 for rank in ranks) / len(ranks))


@given(st.permutations(range(5)))
def test_the_order_of_queries_changes_nothing(order: list[int]) -> None:
    shuffled = Trace.from_frame(TRACE.to_frame().iloc[order])
    assert evaluate(shuffled) == pytest.approx(evaluate(TRACE), nan_ok=True)
