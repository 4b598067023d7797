"""Every metric of a trace in one flat row, by both rules of what is right."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float64, Int64

from vprbench.precision_recall import CURVE_METRICS, tally
from vprbench.trace import Trace
from vprbench.types import NO_PLACE

__all__ = ["METRICS", "RECALL_DEPTHS", "evaluate", "recall_at"]

RECALL_DEPTHS = (1, 5, 10, 20)

# The columns of `evaluate`, in order; the metric rule's carry a suffix.
_RULE_METRICS = (*CURVE_METRICS, *(f"recall_at_{depth}" for depth in RECALL_DEPTHS))
METRICS = (
    *_RULE_METRICS,
    *(f"{name}_metric" for name in _RULE_METRICS),
    "error_mean_m",
    "error_median_m",
    "no_match",
)


def recall_at(rank: Int64[np.ndarray, " queries"], depth: int) -> float:
    """Share of all queries with a right place among the `depth` best: recall@N from ranks (0 first, -1 none)."""
    return float(((rank >= 0) & (rank < depth)).mean())


def evaluate(trace: Trace) -> dict[str, float]:
    """Every metric of a trace, named as in `METRICS`: by the place-field rule, and by the metric rule (`_metric`).

    The errors in metres are over the queries with a hypothesis (NaN when there is none); `no_match` is the share
    of the others.
    """
    values = _rule(trace.correct, trace.confidence, trace.rank)
    metric = _rule(trace.correct_metric, trace.confidence, trace.rank_metric)
    errors = trace.error_m[~np.isnan(trace.error_m)]
    values |= {f"{name}_metric": value for name, value in metric.items()}
    values["error_mean_m"] = float(errors.mean()) if errors.size else float("nan")
    values["error_median_m"] = float(np.median(errors)) if errors.size else float("nan")
    values["no_match"] = float((trace.hypothesis == NO_PLACE).mean())
    return values


def _rule(
    correct: Bool[np.ndarray, " queries"],
    confidence: Float64[np.ndarray, " queries"],
    rank: Int64[np.ndarray, " queries"],
) -> dict[str, float]:
    """The metrics by one rule of what is right."""
    counts = tally(correct, confidence)
    scores = {name: float(metric(counts)[0]) for name, metric in CURVE_METRICS.items()}
    return scores | {f"recall_at_{depth}": recall_at(rank, depth) for depth in RECALL_DEPTHS}
