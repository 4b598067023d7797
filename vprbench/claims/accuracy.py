"""What can be measured of accuracy: differences, levels and spreads of AUC over the cells of a study, in points.

AUC is that of VPR-Bench, which is nearest to what the paper describes; the remarks tell what the AUC over all queries
and the top-1 accuracy say. A point is a hundredth: where the paper says "10 %" we read 10 points.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from jaxtyping import Float64

from vprbench.bootstrap import BLOCK_M, LEVEL, RESAMPLES, widening
from vprbench.claims.answers import Answers, find_answers
from vprbench.claims.reading import Evidence, Measurement, Reading, Untestable
from vprbench.paired import compare
from vprbench.paired_scores import score_cells

__all__ = ["AucDifference", "AucGrowth", "AucLevel", "SpreadRatio"]

METRIC = "auc"
OTHERS: Mapping[str, str] = {"auc_all": "AUC over all queries", "accuracy": "top-1"}

# Agents x routes x distances x draws; the first draw is of the queries themselves.
Scores = Float64[np.ndarray, "agents routes distances draws"]


class AucDifference(Measurement):
    """An agent's mean AUC less another's, on the same queries (`vprbench.paired`).

    Attributes:
        agent: canonical name.
        reference: canonical name.
        distances: sampling distances, metres; all by default.
    """

    kind: Literal["auc-difference"]
    agent: str
    reference: str
    distances: tuple[float, ...] = ()

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The difference and its paired interval."""
        found = find_answers(evidence, study, routes, (self.agent, self.reference), distances=self.distances)
        row = self._compared(found, METRIC)
        others = (f"{label} {_signed(self._compared(found, metric))}" for metric, label in OTHERS.items())
        basis = f"{row['cells']} cells, {row['queries']} queries, seeds {row['seeds']} and {row['reference_seeds']}"
        value, low, high = (100 * float(row[name]) for name in ("difference", "low", "high"))
        return Reading(value, low, high, f"{found.measured_on}; {basis}", found.at_home, "; ".join(others))

    def _compared(self, found: Answers, metric: str) -> dict[str, Any]:
        (row,) = compare(found.traces, metric, agents=[self.agent], reference=self.reference).to_dict("records")
        return {str(key): value for key, value in row.items()}


class AucGrowth(Measurement):
    """By how much more an agent leads another at one sampling distance than at a second.

    Attributes:
        agent: canonical name.
        reference: canonical name.
        distance: metres.
        reference_distance: metres.
    """

    kind: Literal["auc-growth"]
    agent: str
    reference: str
    distance: float
    reference_distance: float

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The growth and its paired interval."""
        agents, distances = (self.agent, self.reference), (self.distance, self.reference_distance)
        found = find_answers(evidence, study, routes, agents, distances=distances)
        scores, factor = _scores(found, agents, distances)
        lead = 100 * (scores[0] - scores[1]).mean(axis=0)
        return _reading(lead[0] - lead[1], factor, found)


class AucLevel(Measurement):
    """The mean AUC of some agents.

    Attributes:
        agents: canonical names.
    """

    kind: Literal["auc-level"]
    agents: tuple[str, ...]

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The mean and its interval."""
        found = find_answers(evidence, study, routes, self.agents)
        scores, factor = _scores(found, self.agents)
        return _reading(100 * scores.mean(axis=(0, 1, 2)), factor, found)


class SpreadRatio(Measurement):
    """How widely an agent's AUC spreads, in parts of how widely another's does.

    The interval is of these roads and says nothing of others; the standard deviations of its resamples carry the
    noise of the queries too, which moves the ratio towards 1.

    Attributes:
        agent: canonical name.
        reference: canonical name.
        over: "routes" for the standard deviation over routes of the mean over distances; "distances" for the mean
            over routes of the standard deviation over distances.
    """

    kind: Literal["spread-ratio"]
    agent: str
    reference: str
    over: Literal["routes", "distances"]

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The ratio and its paired interval."""
        agents = (self.agent, self.reference)
        found = find_answers(evidence, study, routes, agents, least=2 if self.over == "routes" else 1)
        scores, _ = _scores(found, agents)
        axis = 1 if self.over == "routes" else 2
        if scores.shape[axis] < 2:
            raise Untestable(f"{study} has but one of the {self.over} that the spread is over")
        # Without a spread in the reference there is no ratio, and any with one is more.
        spread = np.maximum(self._spread(scores), 1e-12)
        remark = f"standard deviations {100 * spread[0, 0]:.1f} and {100 * spread[1, 0]:.1f} points"
        return _reading(spread[0] / spread[1], 1.0, found, remark)

    def _spread(self, scores: Scores) -> Float64[np.ndarray, "agents draws"]:
        if self.over == "routes":
            return scores.mean(axis=2).std(axis=1, ddof=1)
        return scores.std(axis=2, ddof=1).mean(axis=1)


def _scores(found: Answers, agents: Sequence[str], distances: Sequence[float] = ()) -> tuple[Scores, float]:
    """Resampled AUC of each agent in each cell, and by how much percentiles of them are to be widened."""
    scored, drives = score_cells(found.traces, METRIC, BLOCK_M, RESAMPLES, 0)
    asked = distances or sorted({distance for places in scored.values() for _, distance in places})
    try:
        rows = [[[scored[a][route, d].draws for d in asked] for route in drives] for a in agents]
    except KeyError as error:
        raise Untestable(f"an agent has no finished cell {error}") from error
    return np.array(rows), widening([drive.blocks for drive in drives.values()])


def _reading(draws: Float64[np.ndarray, " draws"], factor: float, found: Answers, remark: str = "") -> Reading:
    """The first draw, and the interval that the others span about it."""
    bounds = np.quantile(draws[1:], [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    low, high = draws[0] + factor * (bounds - draws[0])
    return Reading(float(draws[0]), float(low), float(high), found.measured_on, found.at_home, remark)


def _signed(row: Mapping[str, Any]) -> str:
    """A difference with its interval, in points."""
    return f"{100 * row['difference']:+.1f} ({100 * row['low']:+.1f} to {100 * row['high']:+.1f})"
