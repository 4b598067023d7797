"""How sure a metric is: intervals by the circular block bootstrap over the frames of a test drive.

Neighbouring frames see almost the same scene and are right or wrong together, so drawing single frames would give
intervals that are too narrow. Whole stretches of road are drawn instead, with the drive closed to a circle so that
every frame is equally likely (Politis & Romano, "A circular block-resampling procedure for stationary data", 1992).

Even so a short drive knows too little about itself: on simulated drives whose frames correlate as an AR(1) process of
coefficient 0.8, a nominal 95 % interval by blocks of 11 frames held the true accuracy in 81 % of the drives of 100
frames and in 88 % of those of 440, one by single frames in 55 and 59 %. Read intervals of short routes as lower bounds.
`widening` tells how much of that comes of the small number of blocks; `vprbench.paired` makes up for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from statistics import NormalDist

import numpy as np
from jaxtyping import Int64

from vprbench.errors import ConfigError
from vprbench.precision_recall import Score, Tally, accuracy, extended_precision, pr_auc, pr_auc_all, tally
from vprbench.trace import Trace

__all__ = [
    "BLOCK_M",
    "INTERVAL_METRICS",
    "LEVEL",
    "RESAMPLES",
    "block_frames",
    "check_settings",
    "interval_rule",
    "intervals",
    "resample",
    "resample_chunks",
    "student_quantile",
    "widening",
]

# `recall_at_1` is the accuracy under its other name.
INTERVAL_METRICS: Mapping[str, Callable[[Tally], Score]] = {
    "auc": pr_auc,
    "auc_all": pr_auc_all,
    "accuracy": accuracy,
    "recall_at_1": accuracy,
    "extended_precision": extended_precision,
}

BLOCK_M, RESAMPLES, LEVEL = 10.0, 2000, 0.95

# Resamples are drawn in chunks of at most this many weights: 8 MB of them at a time.
CHUNK = 1_000_000


def interval_rule(unit: str = "m") -> str:
    """How intervals are found, said in every row that carries one; a block is as long on a route in frames."""
    return f"{LEVEL:.0%} percentiles of {RESAMPLES} circular block-bootstrap resamples, blocks of {BLOCK_M:g} {unit}"


def resample(
    queries: int, block: int, resamples: int, rng: np.random.Generator
) -> Int64[np.ndarray, "resamples queries"]:
    """How often each query stands in each resample: blocks at random starts, the last cut to make up the number.

    Block length 1 is the ordinary bootstrap of independent queries.
    """
    starts = rng.integers(queries, size=(resamples, -(-queries // block)))
    drawn = (starts[:, :, None] + np.arange(block)) % queries
    drawn = drawn.reshape(resamples, -1)[:, :queries] + queries * np.arange(resamples)[:, None]
    return np.bincount(drawn.ravel(), minlength=resamples * queries).reshape(resamples, queries)


def block_frames(trace: Trace, block_m: float) -> int:
    """Number of frames in a block of this length of road, by the mean spacing of the drive; at least 1."""
    steps = np.hypot(np.diff(trace.east), np.diff(trace.north))
    travelled = float(steps.sum())
    if travelled == 0.0:
        return len(trace)
    return int(np.clip(round(block_m * len(steps) / travelled), 1, len(trace)))


def intervals(
    trace: Trace, *, block_m: float = BLOCK_M, resamples: int = RESAMPLES, level: float = LEVEL, seed: int = 0
) -> dict[str, float]:
    """Percentile intervals of the metrics in `INTERVAL_METRICS`, by both rules: `auc_low`, `auc_high`, and so on.

    They say how far the score would move on other stretches of the same kind of road, not with another dictionary
    seed. A drive of fewer than two blocks cannot say, and its intervals are NaN. One seed draws the same blocks for
    every agent on a route, so that their intervals can be compared.

    Args:
        trace: the test drive.
        block_m: length of a block, metres of road (our choice: the road over which a scene stays in view).
        resamples: how many are drawn (our choice).
        level: share of the resamples inside the interval.
        seed: of the drawing.

    Raises:
        ConfigError: a block, number of resamples or level that is not positive, or a level of 1 or more.
    """
    check_settings(block_m, resamples, level)
    block = block_frames(trace, block_m)
    chunks = [_scores(trace, weights) for weights in resample_chunks(len(trace), block, resamples, seed)]
    scores = {name: np.concatenate([chunk[name] for chunk in chunks]) for name in chunks[0]}
    enough, tails = len(trace) >= 2 * block, ((1 - level) / 2, (1 + level) / 2)
    bounds = {name: np.quantile(scores[name], tails) if enough else (np.nan, np.nan) for name in scores}
    return {
        f"{name}_{side}": float(bound)
        for name, pair in bounds.items()
        for side, bound in zip(("low", "high"), pair, strict=True)
    }


def check_settings(block_m: float, resamples: int, level: float) -> None:
    """Refuse a block, number of resamples or level that is not positive, or a level of 1 or more: ConfigError."""
    if not (block_m > 0 and resamples >= 1 and 0 < level < 1):
        raise ConfigError(
            f"bootstrap: block_m={block_m}, resamples={resamples}, level={level}; all must be positive, level below 1"
        )


def resample_chunks(
    queries: int, block: int, resamples: int, seed: int | Sequence[int]
) -> Iterator[Int64[np.ndarray, "chunk queries"]]:
    """All the resamples, so many at a time that memory stays bounded."""
    rng = np.random.default_rng(seed)
    size = max(1, CHUNK // queries)
    for done in range(0, resamples, size):
        yield resample(queries, block, min(size, resamples - done), rng)


def widening(blocks: Sequence[float], level: float = LEVEL, others: Sequence[tuple[float, float]] = ()) -> float:
    """By how much a percentile interval of the mean over drives is too narrow, given how many blocks each has.

    Resampling divides by the number of blocks, not of degrees of freedom (one less a drive), and its tails are those
    of the normal distribution, not Student's: sqrt(blocks / degrees) t / z, the "expanded" percentile interval of
    Hesterberg, "What teachers should know about the bootstrap", The American Statistician, 2015. NaN where a drive
    has fewer than two blocks.

    Args:
        blocks: of each drive.
        level: of the interval.
        others: the share of the variance that comes of something else which is drawn too, without that fault, and its
            degrees of freedom; they join by Satterthwaite's rule (Biometrics Bulletin, 1946).
    """
    if min(blocks) < 2:
        return float("nan")
    road, tail = sum(blocks) - len(blocks), (1 + level) / 2
    parts = [(max(0.0, 1 - sum(share for share, _ in others)) * sum(blocks) / road, road), *others]
    whole = sum(share for share, _ in parts)
    degrees = whole**2 / sum(share**2 / free for share, free in parts)
    return whole**0.5 * student_quantile(tail, degrees) / NormalDist().inv_cdf(tail)


@cache
def student_quantile(share: float, degrees: float) -> float:
    """The value below which this share (1/2 or more) of Student's t distribution lies.

    With t = sqrt(degrees) tan(angle), the density of the angle is proportional to cos(angle) ^ (degrees - 1).
    """
    angle = np.linspace(0.0, np.pi / 2, 200_001)
    density = np.cos(angle) ** (degrees - 1)
    mass = np.concatenate([[0.0], np.cumsum(density[1:] + density[:-1])])
    return float(degrees**0.5 * np.tan(np.interp((2 * share - 1) * mass[-1], mass, angle)))


def _scores(trace: Trace, weights: Int64[np.ndarray, "chunk queries"]) -> dict[str, Score]:
    """Every interval metric of every resample, by both rules."""
    rules = {"": trace.correct, "_metric": trace.correct_metric}
    counts = {rule: tally(correct, trace.confidence, weights) for rule, correct in rules.items()}
    return {f"{name}{rule}": score(counts[rule]) for rule in rules for name, score in INTERVAL_METRICS.items()}
