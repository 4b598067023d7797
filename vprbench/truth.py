"""When a hypothesis is right: the place-field rule and the metric rule.

Every test frame q has its own localization tolerance, d_NN(q): the distance from q to the nearest frame of the
learn drive. The paper adds "a tolerance, specific for each location, on the basis of the GPS imprecision (0.79 m
on average, sd 0.98 m)"; d_NN averaged over its three routes is 0.794 m, sd 0.965 m, so we infer that this is it.

A data set that says itself which learn frames are right for a test frame (`within`, `listed`) takes the place of
d_NN: both rules go by its frames. A test frame that it gives none can be answered by nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int64

from vprbench.types import NO_PLACE

__all__ = ["Revisit", "listed", "metric_truth", "place_field_truth", "ranks", "revisit", "within"]

Gaps = Float64[np.ndarray, "queries frames"]


@dataclass(frozen=True)
class Revisit:
    """How a test drive lies beside its learn drive; distances are in the route's unit, metres or frames.

    Attributes:
        nearest: (queries,) the learn frame nearest to each test frame.
        tolerance: (queries,) how far from a test frame is still right: d_NN, the distance to the nearest learn
            frame, unless the data set has a tolerance of its own.
        gaps: (queries, frames) the distance from each test frame to each learn frame; NaN where none is known.
        answers: (queries, frames) the frames at which a right hypothesis must have won. By d_NN those within the
            tolerance of the nearest one, {f : |f - nn(q)| <= d_NN(q)}, where nn(q) itself is always one.
        rule: where the tolerance comes from, in words for every row of results.
    """

    nearest: Int64[np.ndarray, " queries"]
    tolerance: Float64[np.ndarray, " queries"]
    gaps: Float64[np.ndarray, "queries frames"]
    answers: Bool[np.ndarray, "queries frames"]
    rule: str = "d_NN: distance from the query to its nearest learn frame"

    @cached_property
    def answered(self) -> Bool[np.ndarray, " queries"]:
        """Which test frames have a right answer at all; by d_NN every one."""
        return np.asarray(self.answers.any(axis=1))

    def true_places(self, winners: Int64[np.ndarray, " frames"]) -> Int64[np.ndarray, " queries"]:
        """The record-phase winner at each query's nearest learn frame; `NO_PLACE` for a query without an answer."""
        return np.where(self.answered, winners[self.nearest], NO_PLACE)


def revisit(learn: Float64[np.ndarray, "frames 2"], test: Float64[np.ndarray, "queries 2"]) -> Revisit:
    """Compare the positions of two drives by d_NN."""
    gaps = _gaps(learn, test)
    nearest = gaps.argmin(axis=1)
    tolerance = gaps[np.arange(len(test)), nearest]
    along = np.linalg.norm(learn[nearest][:, None] - learn[None], axis=2)
    return Revisit(nearest, tolerance, gaps, along <= tolerance[:, None])


def within(
    learn: Float64[np.ndarray, "frames 2"], test: Float64[np.ndarray, "queries 2"], tolerance: float, unit: str
) -> Revisit:
    """Compare the positions of two drives by one tolerance for every query, as a data set states it.

    The answers are the learn frames within it; a query may have none.
    """
    gaps = _gaps(learn, test)
    rule = _counted(f"learn frames within {tolerance:g} {unit} of the query", gaps <= tolerance)
    return Revisit(gaps.argmin(axis=1), np.full(len(test), float(tolerance)), gaps, gaps <= tolerance, rule)


def listed(learn: Float64[np.ndarray, "frames 2"], answers: Bool[np.ndarray, "queries frames"], source: str) -> Revisit:
    """What a list of the right learn frames of each query says, where no distance between the drives is known.

    A gap is the distance from a learn frame to the nearest one on the query's list, and the tolerance is zero.

    Args:
        learn: positions of the learn drive.
        answers: the list, as marks.
        source: where the list stands, in words.
    """
    gaps = np.full(answers.shape, np.nan)
    for row in np.flatnonzero(answers.any(axis=1)):
        gaps[row] = _gaps(learn[answers[row]], learn).min(axis=1)
    rule = _counted(f"learn frames that {source} lists for the query", answers)
    return Revisit(answers.argmax(axis=1), np.zeros(len(answers)), gaps, answers, rule)


def place_field_truth(
    visit: Revisit, winners: Int64[np.ndarray, " frames"], places: int
) -> Bool[np.ndarray, "queries places"]:
    """Which places are right for each query: the record-phase winners at its answer frames.

    `winners` is the place that responded most at each learn frame, `NO_PLACE` where none did.
    """
    won = winners[:, None] == np.arange(places)[None]
    return visit.answers.astype(np.float32) @ won.astype(np.float32) > 0


def metric_truth(
    visit: Revisit, place_frames: Int64[np.ndarray, " places"], sampling_distance: float
) -> Bool[np.ndarray, "queries places"]:
    """Which places are right for each query by distance alone: within half a sampling distance plus its tolerance."""
    return visit.gaps[:, place_frames] <= sampling_distance / 2 + visit.tolerance[:, None]


def ranks(
    responses: Float32[np.ndarray, "queries places"], right: Bool[np.ndarray, "queries places"]
) -> Int64[np.ndarray, " queries"]:
    """Rank (from 0) of each query's best-ranked right place among all places; -1 where none responds.

    Of equal responses the earlier place ranks first; NaN and zero responses are no answer.
    """
    known = np.nan_to_num(responses, nan=0.0)
    order = np.argsort(-known, axis=1, kind="stable")
    hits = np.take_along_axis(right & (known > 0), order, axis=1)
    return np.where(hits.any(axis=1), hits.argmax(axis=1), NO_PLACE)


def _gaps(learn: Float64[np.ndarray, "frames 2"], test: Float64[np.ndarray, "queries 2"]) -> Gaps:
    return np.linalg.norm(test[:, None] - learn[None], axis=2)


def _counted(rule: str, answers: Bool[np.ndarray, "queries frames"]) -> str:
    """The rule, and how many queries it leaves without an answer."""
    none = int((~answers.any(axis=1)).sum())
    return f"{rule}; {none} of {len(answers)} queries have none" if none else rule
