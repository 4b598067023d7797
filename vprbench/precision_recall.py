"""Precision and recall over confidence: exact thresholds, the curve, and the scores that follow from it.

A query without a match is a hypothesis of confidence 0 that is never right. Every distinct confidence is a threshold,
and queries of equal confidence pass it together. All scores take many resamples of the same queries at once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float64, Int64

from vprbench.errors import DataError

__all__ = [
    "CURVE_METRICS",
    "Curve",
    "Score",
    "Tally",
    "accuracy",
    "curve",
    "extended_precision",
    "pr_auc",
    "pr_auc_all",
    "recall_at_100_precision",
    "recall_at_100_precision_all",
    "roc_auc",
    "tally",
]


class Tally(NamedTuple):
    """How many hypotheses pass each threshold, and how many of those are right; one row a (re)sample.

    The last threshold passes every query, so the last columns are the right top-1s and the queries.
    """

    thresholds: Float64[np.ndarray, " thresholds"]
    right: Int64[np.ndarray, "samples thresholds"]
    passed: Int64[np.ndarray, "samples thresholds"]


class Curve(NamedTuple):
    """A precision-recall curve from recall 0 upwards; it opens with precision 1 at threshold infinity."""

    thresholds: Float64[np.ndarray, " points"]
    precision: Float64[np.ndarray, " points"]
    recall: Float64[np.ndarray, " points"]


Score = Float64[np.ndarray, " samples"]


def tally(
    correct: Bool[np.ndarray, " queries"],
    confidence: Float64[np.ndarray, " queries"],
    weights: Int64[np.ndarray, "samples queries"] | None = None,
) -> Tally:
    """Count at every exact threshold, from the surest down; `weights` is how often each sample holds each query.

    Raises:
        DataError: there are no queries, the lengths differ, or a confidence is NaN.
    """
    if correct.shape != confidence.shape or not correct.size or np.isnan(confidence).any():
        raise DataError(f"cannot score {correct.size} answers by {confidence.size} confidences (none may be NaN)")
    if weights is None:
        weights = np.ones((1, len(correct)), np.int64)
    order = np.argsort(-confidence, kind="stable")
    confidence = confidence[order]
    last_of_ties = np.flatnonzero(np.append(confidence[1:] != confidence[:-1], True))
    # `take` keeps the rows contiguous, so that a sum along one does not depend on how many there are.
    passed = np.take(weights, order, axis=1)
    right = passed * correct[order]
    return Tally(
        confidence[last_of_ties],
        np.take(right.cumsum(axis=1), last_of_ties, axis=1),
        np.take(passed.cumsum(axis=1), last_of_ties, axis=1),
    )


def accuracy(counts: Tally) -> Score:
    """Share of all queries whose hypothesis is right: top-1 accuracy."""
    return _share(counts.right[:, -1], counts.passed[:, -1])


def pr_auc(counts: Tally) -> Score:
    """Area under precision over recall, recall relative to the right top-1s; 0 when nothing is right.

    The definition of VPR-Bench (Zaffar et al., IJCV 2021), which is scikit-learn's `auc` of its
    `precision_recall_curve`: trapezoids, opening at recall 0 with precision 1. It always reaches recall 1.
    """
    return _area(_recall(counts), _precision(counts), opening=1.0)


def pr_auc_all(counts: Tally) -> Score:
    """Area under precision over recall, recall relative to all queries: `pr_auc` times `accuracy`."""
    return _area(_share(counts.right, counts.passed[:, -1:]), _precision(counts), opening=1.0)


def recall_at_100_precision(counts: Tally) -> Score:
    """Share of the right top-1s that are surer than every wrong hypothesis."""
    return _share(_faultless(counts), counts.right[:, -1])


def recall_at_100_precision_all(counts: Tally) -> Score:
    """Share of all queries that are right and surer than every wrong hypothesis."""
    return _share(_faultless(counts), counts.passed[:, -1])


def extended_precision(counts: Tally) -> Score:
    """Mean of the precision at the lowest recall and the recall at 100 % precision (Ferrarini et al., RA-L 2020).

    As VPR-Bench computes it: the lowest recall is the one at the highest confidence there is.
    """
    surest = (counts.passed > 0).argmax(axis=1)[:, None]
    opening = np.take_along_axis(_precision(counts), surest, axis=1)[:, 0]
    return (opening + recall_at_100_precision(counts)) / 2


def roc_auc(counts: Tally) -> Score:
    """Chance that a right hypothesis is surer than a wrong one, ties half; NaN when one of them is absent."""
    wrong = counts.passed - counts.right
    both = (counts.right[:, -1] > 0) & (wrong[:, -1] > 0)
    area = _area(_share(wrong, wrong[:, -1:]), _recall(counts), opening=0.0)
    return np.where(both, area, np.nan)


def curve(correct: Bool[np.ndarray, " queries"], confidence: Float64[np.ndarray, " queries"]) -> Curve:
    """The curve under which `pr_auc` is the area; multiply recall by the accuracy for that over all queries."""
    counts = tally(correct, confidence)
    return Curve(
        np.append(np.inf, counts.thresholds),
        np.append(1.0, _precision(counts)[0]),
        np.append(0.0, _recall(counts)[0]),
    )


CURVE_METRICS: Mapping[str, Callable[[Tally], Score]] = {
    "auc": pr_auc,
    "auc_all": pr_auc_all,
    "accuracy": accuracy,
    "recall_at_100_precision": recall_at_100_precision,
    "recall_at_100_precision_all": recall_at_100_precision_all,
    "extended_precision": extended_precision,
    "roc_auc": roc_auc,
}


def _share(
    part: Int64[np.ndarray, "..."], whole: Int64[np.ndarray, "..."], of_nothing: float = 0.0
) -> Float64[np.ndarray, "..."]:
    """Part of a whole, and what to say where the whole is nothing."""
    return np.where(whole > 0, part / np.maximum(whole, 1), of_nothing)


def _precision(counts: Tally) -> Float64[np.ndarray, "samples thresholds"]:
    # A resample may hold nobody above a threshold: there its curve still stands at the opening point.
    return _share(counts.right, counts.passed, of_nothing=1.0)


def _recall(counts: Tally) -> Float64[np.ndarray, "samples thresholds"]:
    return _share(counts.right, counts.right[:, -1:])


def _faultless(counts: Tally) -> Int64[np.ndarray, " samples"]:
    """How many right hypotheses pass the lowest threshold that no wrong one passes.

    right == passed holds from the surest threshold down to the first wrong hypothesis, and nowhere below it.
    """
    return np.where(counts.right == counts.passed, counts.right, 0).max(axis=1)


def _area(
    x: Float64[np.ndarray, "samples thresholds"], y: Float64[np.ndarray, "samples thresholds"], opening: float
) -> Score:
    """Trapezoidal area from (0, opening) on."""
    x = np.pad(x, ((0, 0), (1, 0)))
    y = np.pad(y, ((0, 0), (1, 0)), constant_values=opening)
    return np.trapezoid(y, x, axis=1)
