"""Block resampling worked by hand, intervals against scikit-learn on literal resamples, coverage on known truth."""

from __future__ import annotations

from typing import Any
from unittest.mock import create_autospec

import numpy as np
import pytest
from scipy import stats
from sklearn import metrics as sk

from vprbench import bootstrap
from vprbench.bootstrap import INTERVAL_METRICS, block_frames, intervals, resample, student_quantile, widening
from vprbench.errors import ConfigError
from vprbench.trace import Trace


def trace_of(correct: np.ndarray, confidence: np.ndarray, spacing: float = 1.0) -> Trace:
    """A straight drive; the metric rule finds every answer right."""
    size = len(correct)
    return Trace(
        frame=np.arange(size),
        truth=np.arange(size),
        hypothesis=np.arange(size),
        confidence=confidence,
        error_m=np.zeros(size),
        tolerance_m=np.zeros(size),
        correct=correct,
        correct_metric=np.ones(size, bool),
        rank=np.where(correct, 0, -1),
        rank_metric=np.zeros(size, np.int64),
        east=spacing * np.arange(size),
        north=np.zeros(size),
    )


@pytest.fixture
def drive() -> Trace:
    """Sixty frames with ties in the confidence; right answers are somewhat surer."""
    rng = np.random.default_rng(5)
    correct = rng.random(60) < 0.7
    return trace_of(correct, np.round(rng.random(60) / 2 + correct / 4, 1))


def drawing(starts: list[list[int]]) -> np.random.Generator:
    """A generator that draws these block starts."""
    generator: np.random.Generator = create_autospec(np.random.Generator, instance=True)
    generator.integers.side_effect = lambda _, size: np.array(starts).reshape(size)  # type: ignore[attr-defined]
    return generator


def test_blocks_close_the_circle_and_the_last_is_cut() -> None:
    # Blocks 4 0, 1 2 and 1 (its 2 is cut); then 0 1, 3 4 and 4.
    weights = resample(5, 2, 2, drawing([[4, 1, 1], [0, 3, 4]]))
    assert weights.tolist() == [[1, 2, 1, 0, 1], [1, 1, 0, 1, 2]]


def test_every_frame_is_equally_likely() -> None:
    for queries, block in ((7, 3), (6, 2), (5, 5), (4, 1)):
        blocks = -(-queries // block)
        starts = [[(start + shift) % queries for start in range(blocks)] for shift in range(queries)]
        weights = resample(queries, block, queries, drawing(starts))
        assert weights.sum(axis=1).tolist() == [queries] * queries
        assert weights.sum(axis=0).tolist() == [queries] * queries


def test_block_length_one_is_the_ordinary_bootstrap() -> None:
    weights = resample(20, 1, 50, np.random.default_rng(3))
    drawn = np.random.default_rng(3).integers(20, size=(50, 20))
    assert weights.tolist() == [np.bincount(row, minlength=20).tolist() for row in drawn]


def test_the_intervals_are_percentiles_of_literal_resamples(drive: Trace) -> None:
    starts = np.random.default_rng(8).integers(60, size=(200, 12))
    rows = (starts[:, :, None] + np.arange(5)).reshape(200, 60) % 60
    accuracy = [drive.correct[row].mean() for row in rows]
    auc = [literal_auc(drive.correct[row], drive.confidence[row]) for row in rows]
    got = intervals(drive, block_m=5.0, resamples=200, level=0.9, seed=8)
    for name, values in {"accuracy": accuracy, "auc": auc, "auc_all": np.multiply(auc, accuracy)}.items():
        low, high = np.quantile(values, [0.05, 0.95])
        assert (got[f"{name}_low"], got[f"{name}_high"]) == pytest.approx((low, high), abs=1e-12)
    assert got["recall_at_1_low"] == got["accuracy_low"]


def literal_auc(correct: np.ndarray, confidence: np.ndarray) -> float:
    precision, recall, _ = sk.precision_recall_curve(correct, confidence)
    return float(sk.auc(recall, precision))


def test_there_is_a_low_and_a_high_for_both_rules(drive: Trace) -> None:
    got = intervals(drive, resamples=50)
    names = {f"{name}{rule}" for name in INTERVAL_METRICS for rule in ("", "_metric")}
    assert got.keys() == {f"{name}_{side}" for name in names for side in ("low", "high")}
    for name in names:
        assert got[f"{name}_low"] <= got[f"{name}_high"]
    # By the metric rule every answer is right, in every resample.
    assert {got[f"{name}_{side}"] for name in names if name.endswith("_metric") for side in ("low", "high")} == {1.0}


def test_same_seed_same_intervals_however_memory_is_cut(drive: Trace, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = intervals(drive, resamples=101, seed=4)
    assert intervals(drive, resamples=101, seed=5) != whole
    monkeypatch.setattr(bootstrap, "CHUNK", 7 * len(drive))
    assert intervals(drive, resamples=101, seed=4) == whole
    monkeypatch.setattr(bootstrap, "CHUNK", 1)
    assert intervals(drive, resamples=101, seed=4) == whole


def test_a_block_in_metres_becomes_frames_by_the_mean_spacing() -> None:
    correct, confidence = np.ones(101, bool), np.ones(101)
    assert block_frames(trace_of(correct, confidence, spacing=0.5), 10.0) == 20
    assert block_frames(trace_of(correct, confidence, spacing=0.9), 10.0) == 11
    assert block_frames(trace_of(correct, confidence, spacing=30.0), 10.0) == 1
    assert block_frames(trace_of(correct, confidence, spacing=0.01), 10.0) == 101
    assert block_frames(trace_of(correct, confidence, spacing=0.0), 10.0) == 101


def test_a_drive_of_less_than_two_blocks_has_no_interval(drive: Trace) -> None:
    assert all(np.isnan(value) for value in intervals(drive, block_m=31.0, resamples=20).values())
    assert not any(np.isnan(value) for value in intervals(drive, block_m=30.0, resamples=20).values())


@pytest.mark.parametrize("setting", [{"block_m": 0.0}, {"resamples": 0}, {"level": 1.0}, {"level": float("nan")}])
def test_senseless_settings_are_refused(drive: Trace, setting: dict[str, Any]) -> None:
    with pytest.raises(ConfigError, match=next(iter(setting))):
        intervals(drive, **setting)


def coverage(right: np.ndarray, truth: float, block_m: float) -> float:
    """Share of the simulated drives, one a row, whose 95 % interval of the accuracy holds the truth."""
    held = 0
    for drive in right:
        got = intervals(trace_of(drive, np.ones(len(drive))), block_m=block_m, resamples=200)
        held += got["accuracy_low"] <= truth <= got["accuracy_high"]
    return held / len(right)


def test_blocks_cover_the_truth_of_a_correlated_drive_where_single_frames_do_not() -> None:
    # Right where an AR(1) process with coefficient 0.8 is positive: the true accuracy is 1/2.
    rng = np.random.default_rng(1)
    state, columns = rng.standard_normal(150), []
    for _ in range(300):
        columns.append(state > 0)
        state = 0.8 * state + 0.6 * rng.standard_normal(150)
    right = np.stack(columns, axis=1)
    blocks, frames = coverage(right, 0.5, block_m=15.0), coverage(right, 0.5, block_m=1.0)
    assert frames < 0.7
    assert blocks > 0.8
    assert abs(blocks - 0.95) < abs(frames - 0.95) / 2


def test_single_frames_cover_the_truth_of_an_uncorrelated_drive() -> None:
    right = np.random.default_rng(2).random((150, 200)) < 0.7
    assert coverage(right, 0.7, block_m=1.0) > 0.9


@pytest.mark.parametrize("degrees", [1.0, 2.0, 3.7, 9.0, 30.0, 400.0])
@pytest.mark.parametrize("share", [0.5, 0.6, 0.975, 0.9995])
def test_students_quantiles_are_scipys(share: float, degrees: float) -> None:
    assert student_quantile(share, degrees) == pytest.approx(stats.t.ppf(share, degrees), rel=1e-6, abs=1e-6)


def test_the_widening_makes_independent_blocks_exact() -> None:
    """Of means of few normal values, the widened normal interval holds the truth 95 times in 100."""
    values = np.random.default_rng(6).standard_normal((20_000, 6))
    # What a bootstrap of single values converges to: the spread divides by their number.
    reach = 1.959964 * values.std(axis=1, ddof=0) / np.sqrt(6)
    away = np.abs(values.mean(axis=1))
    assert (away <= widening([6.0]) * reach).mean() == pytest.approx(0.95, abs=0.006)
    assert (away <= reach).mean() < 0.89


def test_what_varies_beside_the_road_joins_by_its_share() -> None:
    assert widening([6.0], others=[(0.0, 4.0)]) == pytest.approx(widening([6.0]))
    assert widening([6.0], others=[(1.0, 4.0)]) == pytest.approx(stats.t.ppf(0.975, 4) / stats.norm.ppf(0.975))
    # Half the variance each: 0.6 and 0.5 after the road's 6/5, with 1.21 / (0.36 / 5 + 0.25 / 4) degrees of freedom.
    half = np.sqrt(1.1) * stats.t.ppf(0.975, 1.21 / (0.072 + 0.0625)) / stats.norm.ppf(0.975)
    assert widening([6.0], others=[(0.5, 4.0)]) == pytest.approx(half)


def test_the_widening_ends_with_many_blocks_and_has_no_answer_for_one() -> None:
    assert widening([1000.0]) == pytest.approx(1.0, abs=0.003)
    assert widening([10.0, 10.0]) == pytest.approx(np.sqrt(20 / 18) * stats.t.ppf(0.975, 18) / stats.norm.ppf(0.975))
    assert np.isnan(widening([10.0, 1.9]))
