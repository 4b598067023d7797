"""Agents that know the truth, and tell it wholly, in part or not at all: what they score is known beforehand."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from vprbench.bootstrap import INTERVAL_METRICS
from vprbench.catalogue import load_route
from vprbench.metrics import METRICS, RECALL_DEPTHS
from vprbench.runner import Outcome
from vprbench.trace import Trace

Answer = Callable[..., Outcome]
Drives = dict[str, tuple[np.ndarray, np.ndarray]]

RULES = ("", "_metric")
BEST_IS_ONE = (
    "auc",
    "auc_all",
    "accuracy",
    "recall_at_100_precision",
    "recall_at_100_precision_all",
    "extended_precision",
    *(f"recall_at_{depth}" for depth in RECALL_DEPTHS),
)


def ok(outcome: Outcome) -> dict[str, Any]:
    """The row of a cell that did not fail."""
    assert outcome.row["status"] == "ok", outcome.row["error"]
    row: dict[str, Any] = outcome.row
    return row


def played(outcome: Outcome) -> Trace:
    """The trace of a cell that did not fail."""
    assert outcome.trace is not None, outcome.row["error"]
    return outcome.trace


def bounds(row: dict[str, Any], rule: str) -> set[float]:
    return {row[f"{name}{rule}_{side}"] for name in INTERVAL_METRICS for side in ("low", "high")}


def distances(here: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Between each row of one and each row of the other."""
    return np.array([[np.hypot(a[0] - b[0], a[1] - b[1]) for b in there] for a in here])


def stepped(positions: np.ndarray, step: float) -> list[int]:
    """Frames at which the road since the last place reaches the step."""
    places, road = [0], 0.0
    for index in range(1, len(positions)):
        road += float(np.hypot(*(positions[index] - positions[index - 1])))
        if road >= step:
            places.append(index)
            road = 0.0
    return places


@pytest.mark.parametrize("route", ["Beside", "Drawn", "Shuffled", "Swapped"])
def test_a_perfect_memory_scores_one_in_everything(answer: Answer, routes: Path, route: str) -> None:
    row = ok(answer(route, "perfect-memory"))
    assert {row[f"{name}{rule}"] for name in BEST_IS_ONE for rule in RULES} == {1.0}
    # Nothing is wrong, so there is no wrong answer to be surer than.
    assert np.isnan(row["roc_auc"])
    assert np.isnan(row["roc_auc_metric"])
    assert row["no_match"] == 0.0
    assert bounds(row, "") == bounds(row, "_metric") == {1.0}
    loaded = load_route(route, routes=routes)
    nearest = distances(loaded.test.positions, loaded.learn.positions).min(axis=1)
    assert row["error_mean_m"] == pytest.approx(nearest.mean(), abs=1e-9)
    assert row["error_median_m"] == pytest.approx(np.median(nearest), abs=1e-9)
    assert row["tolerance_mean_m"] == pytest.approx(nearest.mean(), abs=1e-9)
    assert row["places"] == len(loaded.learn)


def test_the_names_of_the_metrics_are_all_judged() -> None:
    errors = {"error_mean_m", "error_median_m", "no_match"}
    judged = {f"{name}{rule}" for name in (*BEST_IS_ONE, "roc_auc") for rule in RULES}
    assert judged | errors == set(METRICS)


@pytest.mark.parametrize("name", ["cheat", "cheat-by-matrix"])
@pytest.mark.parametrize("route", ["Beside", "Drawn", "Swapped"])
@pytest.mark.parametrize("distance", [2.0, 5.0])
def test_a_cheat_scores_one_by_the_place_fields(answer: Answer, name: str, route: str, distance: float) -> None:
    row = ok(answer(route, name, distance))
    assert [row[metric] for metric in BEST_IS_ONE] == pytest.approx([1.0] * len(BEST_IS_ONE), abs=1e-12)
    assert row["accuracy"] == row["recall_at_100_precision_all"] == 1.0
    # Unequal confidences make the area a sum of many parts.
    assert sorted(bounds(row, "")) == pytest.approx([1.0] * len(bounds(row, "")), abs=1e-12)
    assert row["place_spacing_m"] == pytest.approx(distance, rel=0.25)


@pytest.mark.parametrize("distance", [2.0, 4.0, 5.0])
def test_by_distance_a_cheat_errs_as_far_as_its_places_lie(answer: Answer, drives: Drives, distance: float) -> None:
    learn, test = drives["Beside"]
    outcome = answer("Beside", "cheat", distance)
    row = ok(outcome)
    places = learn[stepped(learn, distance)]
    gaps = distances(test, learn)
    chosen = distances(learn[gaps.argmin(axis=1)], places).argmin(axis=1)
    error = distances(test, places)[np.arange(len(test)), chosen]
    np.testing.assert_allclose(played(outcome).error_m, error, atol=1e-9)
    assert row["error_mean_m"] == pytest.approx(error.mean())
    # The places divide this road without a rest, so none is ever further off than half a distance and the tolerance.
    assert row["accuracy_metric"] == (error <= distance / 2 + gaps.min(axis=1)).mean()
    assert row["accuracy_metric"] == 1.0


def test_always_place_zero_scores_its_share(answer: Answer, drives: Drives) -> None:
    learn, test = drives["Beside"]
    row = ok(answer("Beside", "one-place", 4.0, recorded="truth"))
    gaps = distances(test, learn)
    places = learn[stepped(learn, 4.0)]
    won = distances(learn, places).argmin(axis=1)
    near = [learn[np.hypot(*(learn - learn[gap.argmin()]).T) <= gap.min()] for gap in gaps]
    fields = [{won[np.flatnonzero((learn == frame).all(axis=1))[0]] for frame in frames} for frames in near]
    share = np.mean([0 in field for field in fields])
    metric = np.mean(distances(test, places[:1])[:, 0] <= 2.0 + gaps.min(axis=1))
    assert 0 < share < 0.1
    for expected, rule in ((share, ""), (metric, "_metric")):
        assert row[f"accuracy{rule}"] == row[f"recall_at_20{rule}"] == expected
        # One threshold: the curve falls straight from precision 1 to the share.
        assert row[f"auc{rule}"] == pytest.approx((1 + expected) / 2)
        assert row[f"auc_all{rule}"] == pytest.approx(expected * (1 + expected) / 2)
        assert row[f"extended_precision{rule}"] == pytest.approx(expected / 2)
        assert row[f"roc_auc{rule}"] == pytest.approx(0.5)
        assert row[f"recall_at_100_precision{rule}"] == 0.0
    assert row["error_mean_m"] == pytest.approx(distances(test, places[:1]).mean())


def test_the_place_fields_alone_do_not_see_that_one_place_answers_everywhere(answer: Answer) -> None:
    """Place 0 wins the record phase everywhere, so it is right everywhere by that rule; distance tells."""
    fooled, seen = (ok(answer("Beside", "one-place", 4.0, recorded=recorded)) for recorded in ("same", "truth"))
    assert fooled["accuracy"] == fooled["auc"] == 1.0
    assert fooled["accuracy_metric"] == seen["accuracy_metric"] < 0.1


@pytest.mark.parametrize("confidence", ["constant", "honest", "random"])
def test_half_right_is_scored_by_what_the_confidence_knows(answer: Answer, drives: Drives, confidence: str) -> None:
    test = drives["Beside"][1]
    row = ok(answer("Beside", "lapse", 4.0, start=20.0, stop=52.0, confidence=confidence))
    share = 1 - ((test[:, 1] >= 20.0) & (test[:, 1] < 52.0)).mean()
    assert row["accuracy"] == row["accuracy_metric"] == row["recall_at_20"] == share
    assert row["auc_all"] == pytest.approx(row["auc"] * share)
    if confidence == "constant":
        assert row["auc"] == pytest.approx((1 + share) / 2)
        assert row["roc_auc"] == 0.5
        assert row["recall_at_100_precision"] == 0.0
    if confidence == "honest":
        assert row["auc"] == row["roc_auc"] == row["recall_at_100_precision"] == row["extended_precision"] == 1.0
        assert row["recall_at_100_precision_all"] == share


def test_who_is_always_right_need_not_know_it(answer: Answer) -> None:
    """Random confidence, no two alike, so that many a resample lacks the surest answers."""
    row = ok(answer("Beside", "lapse", 4.0, start=90.0, stop=90.0, confidence="random"))
    assert len(BEST_IS_ONE) == sum(row[name] == pytest.approx(1.0, abs=1e-12) for name in BEST_IS_ONE)
    assert sorted(bounds(row, "")) == pytest.approx([1.0] * len(bounds(row, "")), abs=1e-12)


@pytest.mark.parametrize("name", ["peek", "peek-by-matrix"])
def test_the_front_door_is_shut(answer: Answer, name: str) -> None:
    row = answer("Beside", name).row
    assert row["status"] == "failed"
    assert "gps" in row["error"]
