"""Area under precision over recall and accuracy of many resamples of one drive, compiled.

The same numbers as `precision_recall.pr_auc` and `accuracy` of a weighted tally, 20 to 30 times sooner.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float64, Int64
from numba import njit

__all__ = ["resampled_auc_and_accuracy"]


def resampled_auc_and_accuracy(
    correct: Bool[np.ndarray, " queries"],
    confidence: Float64[np.ndarray, " queries"],
    weights: Int64[np.ndarray, "samples queries"],
) -> tuple[Float64[np.ndarray, " samples"], Float64[np.ndarray, " samples"]]:
    """`pr_auc` and `accuracy` of each resample; `weights` is how often it holds each query, and none is empty."""
    order = np.argsort(-confidence, kind="stable")
    ranked = confidence[order]
    closes_tie = np.append(ranked[1:] != ranked[:-1], True)
    return _scores(correct[order], order, closes_tie, weights)


@njit(cache=True, nogil=True)
def _scores(
    correct: np.ndarray, order: np.ndarray, closes_tie: np.ndarray, weights: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """One pass down the confidences for each resample; a threshold counts once all its ties have passed."""
    samples, queries = weights.shape
    auc, accuracy = np.zeros(samples), np.zeros(samples)
    for sample in range(samples):
        right = passed = right_before = 0
        precision, area = 1.0, 0.0
        for rank in range(queries):
            weight = weights[sample, order[rank]]
            passed += weight
            if correct[rank]:
                right += weight
            if closes_tie[rank] and passed > 0:
                before = precision
                precision = right / passed
                area += (right - right_before) * (before + precision) / 2
                right_before = right
        accuracy[sample] = right / passed
        if right > 0:
            auc[sample] = area / right
    return auc, accuracy
