"""What must happen to scores when a drive is shuffled, both are swapped, or both are one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from vprbench.bootstrap import block_frames
from vprbench.metrics import METRICS
from vprbench.runner import Outcome
from vprbench.trace import Trace

Answer = Callable[..., Outcome]
Drives = dict[str, tuple[np.ndarray, np.ndarray]]

STRETCH = {"start": 20.0, "stop": 40.0, "confidence": "constant"}


def scores(outcome: Outcome) -> dict[str, float]:
    assert outcome.row["status"] == "ok", outcome.row["error"]
    return {name: outcome.row[name] for name in METRICS}


def played(outcome: Outcome) -> Trace:
    """The trace of a cell that did not fail."""
    assert outcome.trace is not None, outcome.row["error"]
    return outcome.trace


@pytest.mark.parametrize(("name", "options"), [("lapse", STRETCH), ("pixels", {}), ("one-place", {"recorded": "same"})])
def test_the_order_of_the_queries_changes_no_metric(answer: Answer, name: str, options: dict[str, Any]) -> None:
    ordered, shuffled = (scores(answer(route, name, **options)) for route in ("Beside", "Shuffled"))
    np.testing.assert_allclose(list(ordered.values()), list(shuffled.values()), rtol=1e-12)


def test_but_the_intervals_lose_their_stretches(answer: Answer) -> None:
    """Shuffled, a wrong stretch is many single wrong answers, and blocks of road are single frames: too narrow."""
    ordered, shuffled = (answer(route, "lapse", **STRETCH) for route in ("Beside", "Shuffled"))
    assert block_frames(played(shuffled), 10.0) == 1
    assert block_frames(played(ordered), 10.0) == 19
    width = {
        name: outcome.row["accuracy_high"] - outcome.row["accuracy_low"]
        for name, outcome in {"ordered": ordered, "shuffled": shuffled}.items()
    }
    right = shuffled.row["accuracy"]
    assert width["shuffled"] == pytest.approx(2 * 1.96 * np.sqrt(right * (1 - right) / 150), rel=0.1)
    assert width["ordered"] > 2 * width["shuffled"]


def test_swapped_drives_swap_the_tolerance(answer: Answer, drives: Drives) -> None:
    outcome = answer("Swapped", "perfect-memory")
    learn, test = drives["Beside"]
    expected = [min(np.hypot(*(query - frame)) for frame in test) for query in learn]
    np.testing.assert_allclose(played(outcome).tolerance_m, expected, atol=1e-9)
    assert (outcome.row["learn_frames"], outcome.row["queries"]) == (150, 81)
    assert outcome.row["tolerance_mean_m"] != answer("Beside", "perfect-memory").row["tolerance_mean_m"]


def test_mirrored_drives_mirror_every_answer(answer: Answer) -> None:
    """The two drives of Mirror differ only in which is called the first: nothing may depend on that."""
    one, other = (answer(route, "pixels", 3.0) for route in ("Mirror", "Mirrored"))
    np.testing.assert_equal(scores(one), scores(other))
    assert 0.2 < one.row["accuracy"] < 0.9
    assert 0.05 < one.row["accuracy_metric"] < 0.95
    assert played(one).to_frame().drop(columns="east").equals(played(other).to_frame().drop(columns="east"))
    assert (played(one).east == 1.0).all()
    assert (played(other).east == 0.0).all()
    for name in ("accuracy_low", "auc_all_high"):
        assert one.row[name] == other.row[name]


def test_the_same_drive_twice_is_recognised_by_whoever_answers_alike(answer: Answer) -> None:
    """d_NN is 0 and each frame its own only answer: whoever answers alike to equal frames is always right."""
    for outcome in (answer("Same", "pixels", 3.0), answer("Same", "one-place", 3.0, recorded="same")):
        assert (played(outcome).tolerance_m == 0.0).all()
        assert {outcome.row[name] for name in ("accuracy", "auc", "auc_all", "recall_at_1", "accuracy_low")} == {1.0}
    memory = answer("Same", "perfect-memory")
    assert (played(memory).error_m == 0.0).all()
    assert {memory.row[f"{name}_metric"] for name in ("accuracy", "auc", "auc_all")} == {1.0}
