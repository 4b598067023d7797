"""Agents that guess: their scores are random, and the mean and spread of those follow from the place fields."""

from __future__ import annotations

from collections.abc import Callable
from math import comb, sqrt

import numpy as np
import pytest

from vprbench.runner import Outcome
from vprbench.trace import Trace

Answer = Callable[..., Outcome]
Drives = dict[str, tuple[np.ndarray, np.ndarray]]

SEEDS = range(12)

# Standard errors: a right scorer strays further once in 16,000 times; the seeds are fixed.
TOLERANCE = 4.0

# Metres between places: few places, so that chance is often right.
DISTANCE = 8.0


class Chance:
    """What guessing among the places of the road Beside must score, from its geometry alone."""

    def __init__(self, learn: np.ndarray, test: np.ndarray) -> None:
        # The learn frames lie a metre apart on a line, and every eighth is a place.
        self.places = learn[::8]
        self.winners = [int(np.argmin(np.abs(self.places[:, 1] - y))) for y in learn[:, 1]]
        self.away = np.array([[np.hypot(*(query - place)) for place in self.places] for query in test])
        gaps = [np.hypot(*(learn - query).T) for query in test]
        self.tolerance = np.array([gap.min() for gap in gaps])
        self.answers = [
            np.flatnonzero(np.abs(learn[:, 1] - learn[gap.argmin(), 1]) <= gap.min()).tolist() for gap in gaps
        ]

    @property
    def fields(self) -> list[set[int]]:
        """The places that are right for each query where the record phase is true."""
        return [{self.winners[frame] for frame in frames} for frames in self.answers]

    def found(self, depth: int) -> np.ndarray:
        """Chance that one of each query's right places is among `depth` of all places, drawn at random."""
        size = len(self.places)
        return np.array([1 - comb(size - len(field), depth) / comb(size, depth) for field in self.fields])


@pytest.fixture(scope="module")
def chance(drives: Drives) -> Chance:
    return Chance(*drives["Beside"])


@pytest.fixture(scope="module")
def guesses(answer: Answer) -> list[Outcome]:
    """One guesser a seed, with a true record phase."""
    return [answer("Beside", "guess", DISTANCE, seed, recorded="truth") for seed in SEEDS]


def played(outcome: Outcome) -> Trace:
    """The trace of a cell that did not fail."""
    assert outcome.trace is not None, outcome.row["error"]
    return outcome.trace


def column(outcomes: list[Outcome], name: str) -> np.ndarray:
    return np.array([outcome.row[name] for outcome in outcomes])


def agrees(values: np.ndarray, expected: float) -> bool:
    """Whether seeds scatter about what is expected of them, by their own standard error."""
    error = values.std(ddof=1) / sqrt(len(values))
    return bool(abs(values.mean() - expected) <= TOLERANCE * error)


def hits_agree(hits: float, chances: np.ndarray) -> bool:
    """Whether so many of independent trials with these chances may well succeed (Poisson's binomial)."""
    return bool(abs(hits - chances.sum()) <= TOLERANCE * sqrt((chances * (1 - chances)).sum()))


def test_there_is_something_to_guess(guesses: list[Outcome], chance: Chance) -> None:
    for outcome in guesses:
        assert outcome.row["status"] == "ok", outcome.row["error"]
        assert outcome.row["places"] == len(chance.places) == 11
        assert outcome.row["no_match"] == 0.0
        np.testing.assert_allclose(played(outcome).tolerance_m, chance.tolerance, atol=1e-9)
    assert len({tuple(played(outcome).hypothesis) for outcome in guesses}) == len(SEEDS)


@pytest.mark.parametrize("depth", [1, 5, 10])
def test_guesses_are_right_as_often_as_chance_has_it(guesses: list[Outcome], chance: Chance, depth: int) -> None:
    queries = len(chance.fields)
    chances = np.tile(chance.found(depth), len(SEEDS))
    assert hits_agree(column(guesses, f"recall_at_{depth}").sum() * queries, chances)
    if depth == 1:
        assert hits_agree(column(guesses, "accuracy").sum() * queries, chances)
        assert 0.08 < chances.mean() < 0.15


def test_by_distance_too(guesses: list[Outcome], chance: Chance) -> None:
    right = (chance.away <= DISTANCE / 2 + chance.tolerance[:, None]).mean(axis=1)
    assert hits_agree(column(guesses, "accuracy_metric").sum() * len(right), np.tile(right, len(SEEDS)))


def test_guesses_err_by_the_mean_distance_to_all_places(guesses: list[Outcome], chance: Chance) -> None:
    spread = sqrt(chance.away.var(axis=1).sum() / len(SEEDS)) / len(chance.away)
    assert abs(column(guesses, "error_mean_m").mean() - chance.away.mean()) <= TOLERANCE * spread


def expected_auc(queries: int, right: int) -> float:
    """The mean area under precision over recall of a random order of so many right among the queries.

    At rank i stands a right answer with chance right / queries; before it, each of the i - 1 others is right with
    chance (right - 1) / (queries - 1). The trapezoid there spans precision before and after; it opens at 1.
    """
    others = (right - 1) / (queries - 1)
    ranks = np.arange(1, queries + 1)
    after = (1 + (ranks - 1) * others) / ranks
    before = np.where(ranks == 1, 1.0, others)
    return float((after + before).sum() / 2 / queries)


def test_the_area_of_a_random_order_is_little_more_than_the_prevalence() -> None:
    rng = np.random.default_rng(0)
    areas = []
    for _ in range(4000):
        right = rng.permutation([True] * 3 + [False] * 5)
        precision = np.concatenate([[1.0], right.cumsum() / np.arange(1, 9)])
        areas.append((right * (precision[1:] + precision[:-1]) / 2).sum() / 3)
    assert agrees(np.array(areas), expected_auc(8, 3))
    assert expected_auc(100_000, 30_000) == pytest.approx(0.3, abs=1e-4)


def test_random_confidence_scores_the_prevalence(guesses: list[Outcome], answer: Answer) -> None:
    lapses = [
        answer("Beside", "lapse", DISTANCE, seed, start=20.0, stop=52.0, confidence="random") for seed in SEEDS[:8]
    ]
    for outcomes in (guesses, lapses):
        right = [int(played(outcome).correct.sum()) for outcome in outcomes]
        expected = np.array([expected_auc(150, count) for count in right])
        assert agrees(column(outcomes, "auc") - expected, 0.0)
        assert agrees(column(outcomes, "auc_all") - expected * np.array(right) / 150, 0.0)
        assert agrees(column(outcomes, "roc_auc"), 0.5)
    assert column(lapses, "auc").mean() == pytest.approx(column(lapses, "accuracy").mean(), abs=0.05)


def test_random_place_fields_are_right_by_chance(answer: Answer, chance: Chance) -> None:
    """Where the record phase guesses too, a query's right places are as many draws as it has answer frames."""
    outcomes = [answer("Beside", "guess", DISTANCE, seed, recorded="same") for seed in SEEDS[:8]]
    miss = 1 - 1 / len(chance.places)
    chances = np.array([1 - miss ** len(frames) for frames in chance.answers])
    accuracy = column(outcomes, "accuracy")
    # Queries share answer frames, so their hits are not independent: judge by the spread over seeds.
    assert agrees(accuracy, chances.mean())
    assert chances.mean() > 1.3 * chance.found(1).mean()


def test_an_interval_holds_what_chance_expects(guesses: list[Outcome], chance: Chance) -> None:
    """Of twelve 95 % intervals of independent guesses, three or more misses would come once in fifty times."""
    expected = chance.found(1).mean()
    held = (column(guesses, "accuracy_low") <= expected) & (expected <= column(guesses, "accuracy_high"))
    assert held.sum() >= len(SEEDS) - 3
