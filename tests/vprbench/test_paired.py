"""Paired differences against scikit-learn on literal resamples, and by what must not change them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from sklearn import metrics as sk

from vprbench.bootstrap import intervals, resample, widening
from vprbench.errors import ConfigError, DataError
from vprbench.paired import PAIRED_METRICS, VERDICTS, compare
from vprbench.precision_recall import accuracy, pr_auc, tally
from vprbench.resampled_scores import resampled_auc_and_accuracy
from vprbench.results import ResultTable
from vprbench.sweep import Cell
from vprbench.trace import Trace

RESULTS = Path(__file__).parents[2] / "results"
Traces = dict[Cell, Trace]


def trace_of(correct: np.ndarray, confidence: np.ndarray | None = None, spacing: float = 1.0) -> Trace:
    """A straight drive, judged alike by both rules."""
    size = len(correct)
    return Trace(
        frame=np.arange(size),
        truth=np.arange(size),
        hypothesis=np.arange(size),
        confidence=np.ones(size) if confidence is None else confidence,
        error_m=np.zeros(size),
        tolerance_m=np.zeros(size),
        correct=correct,
        correct_metric=correct,
        rank=np.where(correct, 0, -1),
        rank_metric=np.where(correct, 0, -1),
        east=spacing * np.arange(size),
        north=np.zeros(size),
    )


def drive(rng: np.random.Generator, queries: int, right: float) -> Trace:
    """Right answers are somewhat surer, and many confidences are equal."""
    correct = rng.random(queries) < right
    return trace_of(correct, np.round(0.1 + rng.random(queries) / 2 + correct / 4, 1))


@pytest.fixture
def traces() -> Traces:
    """Three agents on two routes at two distances, one of them with three seeds."""
    rng = np.random.default_rng(7)
    agents = {"poor": (0.5, 1), "good": (0.9, 1), "learned": (0.7, 3)}
    return {
        Cell(route, agent, distance, seed): drive(rng, queries, right)
        for route, queries in {"Long": 120, "Short": 60}.items()
        for distance in (2.0, 5.0)
        for agent, (right, seeds) in agents.items()
        for seed in range(seeds)
    }


def only(answers: Mapping[Cell, Trace], *agents: str, **setting: object) -> dict[str, Any]:
    """The single row of a comparison of two agents, the first with the second."""
    table = compare(answers, agents=agents[:1], reference=agents[1], **setting)  # type: ignore[arg-type]
    (row,) = table.to_dict("records")
    return {str(name): value for name, value in row.items()}


@given(
    hnp.arrays(np.bool_, 12),
    hnp.arrays(np.int8, 12, elements=st.integers(0, 4)),
    hnp.arrays(np.int64, (3, 12), elements=st.integers(0, 3)),
)
def test_the_compiled_scores_are_those_of_the_tally(
    correct: np.ndarray, level: np.ndarray, weights: np.ndarray
) -> None:
    weights[:, 0] += 1
    auc, share = resampled_auc_and_accuracy(correct, level / 4, weights)
    counts = tally(correct, level / 4, weights)
    np.testing.assert_allclose(auc, pr_auc(counts), atol=1e-12)
    np.testing.assert_allclose(share, accuracy(counts), atol=1e-12)


def literal(trace: Trace, rows: np.ndarray, metric: str) -> np.ndarray:
    """A metric of literal resamples, by scikit-learn."""
    values = []
    for row in rows:
        correct = trace.correct[row]
        precision, recall, _ = sk.precision_recall_curve(correct, trace.confidence[row])
        values.append({"auc": sk.auc(recall, precision), "accuracy": correct.mean()}.get(metric, 0.0))
    return np.array(values)


@pytest.mark.parametrize("metric", ["auc", "accuracy", "auc_all"])
def test_the_interval_is_that_of_literal_resamples(traces: Traces, metric: str) -> None:
    """Ten blocks of 12 frames drawn by the route's own stream, the same for both agents."""
    two = {cell: trace for cell, trace in traces.items() if cell.route == "Long" and cell.sampling_distance == 2.0}
    row = only(two, "good", "poor", metric=metric, block_m=12.0, resamples=150, seed=3)
    starts = np.random.default_rng([3, crc32(b"Long")]).integers(120, size=(150, 10))
    drawn = (starts[:, :, None] + np.arange(12)).reshape(150, 120) % 120
    rows = np.concatenate([np.arange(120)[None], drawn])
    scores = []
    for agent in ("good", "poor"):
        trace = two[Cell("Long", agent, 2.0, 0)]
        parts = metric.split("_")[0], "accuracy"
        values = literal(trace, rows, parts[0])
        scores.append(values * literal(trace, rows, parts[1]) if metric == "auc_all" else values)
    difference, *resampled = scores[0] - scores[1]
    assert row["difference"] == pytest.approx(difference, abs=1e-12)
    # Ten blocks: nine degrees of freedom, whose t is 2.262157 where the normal distribution has 1.959964.
    factor = np.sqrt(10 / 9) * 2.262157 / 1.959964
    low, high = difference + factor * (np.quantile(resampled, [0.025, 0.975]) - difference)
    assert (row["low"], row["high"]) == pytest.approx((low, high), abs=1e-6)


def test_a_mean_over_cells_counts_each_route_and_distance_once(traces: Traces) -> None:
    row = only(traces, "learned", "good", metric="accuracy")
    by_cell = [
        np.mean([traces[Cell(route, "learned", distance, seed)].correct.mean() for seed in range(3)])
        - traces[Cell(route, "good", distance, 0)].correct.mean()
        for route in ("Long", "Short")
        for distance in (2.0, 5.0)
    ]
    assert row["difference"] == pytest.approx(np.mean(by_cell))
    assert (row["cells"], row["queries"], row["seeds"], row["reference_seeds"]) == (4, 180, 3, 1)


def test_cells_that_only_one_agent_answered_are_left_out(traces: Traces) -> None:
    fewer = {c: t for c, t in traces.items() if not (c.agent == "good" and c.route == "Short")}
    row = only(fewer, "poor", "good")
    assert (row["cells"], row["queries"]) == (2, 120)
    alone = {c: t for c, t in traces.items() if (c.agent == "good") == (c.route == "Short")}
    with pytest.raises(DataError, match="poor and good have no finished cell in common"):
        only(alone, "poor", "good")


@pytest.mark.parametrize("metric", PAIRED_METRICS)
def test_equal_agents_do_not_differ_at_all(traces: Traces, metric: str) -> None:
    twin = {Cell(c.route, "twin", c.sampling_distance, c.seed): t for c, t in traces.items() if c.agent == "learned"}
    row = only({**traces, **twin}, "twin", "learned", metric=metric)
    assert (row["difference"], row["low"], row["high"]) == (0.0, 0.0, 0.0)
    assert row["verdict"] == "no difference shown"


@pytest.mark.parametrize("metric", PAIRED_METRICS)
def test_exchanged_agents_exchange_the_sign(traces: Traces, metric: str) -> None:
    there, back = only(traces, "learned", "poor", metric=metric), only(traces, "poor", "learned", metric=metric)
    assert there["difference"] == -back["difference"]
    assert (there["low"], there["high"]) == pytest.approx((-back["high"], -back["low"]), abs=1e-12)
    assert there["verdict"] == "better"
    assert back["verdict"] == "worse"


def test_without_a_reference_each_pair_stands_once_the_largest_difference_first(traces: Traces) -> None:
    table = compare(traces, "accuracy")
    assert {frozenset(pair) for pair in zip(table["agent"], table["reference"], strict=True)} == {
        frozenset(pair) for pair in (("poor", "good"), ("poor", "learned"), ("good", "learned"))
    }
    assert table["difference"].is_monotonic_decreasing
    assert set(table["verdict"]) <= set(VERDICTS)
    assert list(zip(table["agent"], table["reference"], strict=True)) == [
        ("good", "poor"),
        ("learned", "poor"),
        ("good", "learned"),
    ]
    back = compare(traces, "accuracy", agents=["good"], reference="poor").drop(columns="metric").iloc[0]
    assert back.equals(table.drop(columns="metric").iloc[0])


def test_other_routes_and_agents_do_not_change_a_comparison(traces: Traces) -> None:
    one = {c: t for c, t in traces.items() if c.route == "Long" and c.agent != "poor"}
    more = {c: t for c, t in traces.items() if c.route == "Long"}
    assert only(one, "learned", "good") == only(more, "learned", "good")


def test_beside_a_faultless_agent_the_interval_is_the_agents_own(traces: Traces) -> None:
    """What never errs adds nothing: the difference is as unsure as the unpaired score, but for the widening."""
    trace = traces[Cell("Long", "good", 2.0, 0)]
    pair = {Cell("Long", "a", 2.0, 0): trace, Cell("Long", "one", 2.0, 0): trace_of(np.ones(120, bool))}
    for metric in ("auc", "auc_all", "accuracy"):
        row = only(pair, "a", "one", metric=metric, resamples=20_000)
        own = intervals(trace, resamples=20_000)
        width = own[f"{metric}_high"] - own[f"{metric}_low"]
        assert (row["high"] - row["low"]) / widening([12.0]) == pytest.approx(width, rel=0.05)


def test_pairing_cancels_what_is_hard_for_both() -> None:
    rng = np.random.default_rng(1)
    hard = np.repeat(rng.random(20) < 0.4, 10)
    one, other = ~hard & (rng.random(200) < 0.95), ~hard & (rng.random(200) < 0.7)
    pair = {Cell("R", "one", 2.0, 0): trace_of(one), Cell("R", "other", 2.0, 0): trace_of(other)}
    row = only(pair, "one", "other", metric="accuracy")
    widths = [got["accuracy_high"] - got["accuracy_low"] for got in map(intervals, pair.values())]
    assert row["verdict"] == "better"
    assert row["high"] - row["low"] < 0.6 * min(widths)


def test_a_drive_of_less_than_two_blocks_shows_nothing(traces: Traces) -> None:
    row = only(traces, "good", "poor", block_m=31.0)
    assert np.isnan([row["low"], row["high"]]).all()
    assert row["verdict"] == "too short to say"
    assert not np.isnan(row["difference"])


def test_seeds_make_a_learned_agent_less_sure() -> None:
    """Five seeds that differ, each right on all or on none of a stretch that every resample holds in equal parts."""
    seeds = [trace_of(np.arange(100) % 10 < right) for right in (2, 4, 6, 8, 9)]
    learned: Traces = {Cell("R", "learned", 2.0, seed): trace for seed, trace in enumerate(seeds)}
    fixed: Traces = {Cell("R", "fixed", 2.0, 0): trace_of(np.arange(100) % 10 < 5)}
    row = only({**learned, **fixed}, "learned", "fixed", metric="accuracy", resamples=20_000)
    # Blocks of ten frames are all alike, so all that varies is the seed: the standard error of a mean of five.
    error = np.std([0.2, 0.4, 0.6, 0.8, 0.9], ddof=1) / np.sqrt(5)
    assert row["difference"] == pytest.approx(0.08)
    # Student's t of four degrees of freedom.
    assert row["high"] - row["low"] == pytest.approx(2 * 2.776445 * error, rel=0.1)


def test_seeds_that_agents_share_are_paired() -> None:
    """Two agents built on the same five dictionaries: good and bad luck with those is no difference between them."""
    rng = np.random.default_rng(4)
    luck, noise = np.array([0.2, 0.4, 0.6, 0.8, 0.9])[:, None], rng.random((2, 5, 100))
    right = noise * 0.2 + np.arange(100) % 10 / 10 < luck
    shared = {Cell("R", "ab"[agent], 2.0, seed): trace_of(right[agent, seed]) for agent, seed in np.ndindex(2, 5)}
    other = {Cell("R", c.agent, 2.0, c.seed + 5 * (c.agent == "b")): trace for c, trace in shared.items()}
    paired, unpaired = (only(cells, "a", "b", metric="accuracy") for cells in (shared, other))
    assert paired["difference"] == pytest.approx(unpaired["difference"])
    assert paired["high"] - paired["low"] < 0.2 * (unpaired["high"] - unpaired["low"])


def test_queries_that_are_not_the_same_are_refused(traces: Traces) -> None:
    moved = trace_of(traces[Cell("Long", "good", 2.0, 0)].correct, spacing=2.0)
    with pytest.raises(DataError, match="Long: its traces are not of the same queries"):
        compare({**traces, Cell("Long", "good", 2.0, 0): moved})


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ({"metric": "acuracy"}, "did you mean 'accuracy'"),
        ({"reference": "god"}, "no finished cell of agent 'god': did you mean 'good'"),
        ({"agents": ["pour"]}, "did you mean 'poor'"),
        ({"agents": ["good"]}, "only one agent"),
        ({"agents": ["good"], "reference": "good"}, "only one agent"),
        ({"resamples": 0}, "resamples=0"),
        ({"level": 1.0}, "level=1.0"),
    ],
)
def test_senseless_questions_are_refused(traces: Traces, setting: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        compare(traces, **setting)


@pytest.mark.parametrize("metric", PAIRED_METRICS)
@pytest.mark.parametrize("name", ["k0-2", "streets"])
def test_a_table_on_disk_is_compared_by_its_traces(name: str, metric: str) -> None:
    table = ResultTable(RESULTS, name)
    row = compare(table, metric, reference="LPMP", resamples=100).set_index("agent").loc["CoHOG"]
    rows = table.frame().query("agent in ('CoHOG', 'LPMP')")
    means = rows.groupby("agent")[metric].mean()
    assert row["difference"] == pytest.approx(means["CoHOG"] - means["LPMP"], abs=2e-6)
    of_routes = rows.groupby("route")["queries"].first()
    assert (row["cells"], row["queries"]) == (3 * len(of_routes), of_routes.sum())


@settings(max_examples=30)
@given(st.integers(0, 1000))
def test_the_same_seed_gives_the_same_table(seed: int) -> None:
    rng = np.random.default_rng(seed)
    pair = {Cell("R", agent, 2.0, 0): drive(rng, 40, 0.6) for agent in ("a", "b")}
    one, again = (compare(pair, resamples=50, seed=seed) for _ in range(2))
    pd.testing.assert_frame_equal(one, again)
    assert resample(40, 10, 1, rng).sum() == 40
