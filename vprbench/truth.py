"""When a hypothesis is right: the place-field rule and the metric rule.

Every test frame q has its own localization tolerance, d_NN(q): the distance from q to the nearest frame of the
learn drive. The paper adds "a tolerance, specific for each location, on the basis of the GPS imprecision (0.79 m
on average, sd 0.98 m)"; d_NN averaged over its three routes is 0.794 m, sd 0.965 m, so we infer that this is it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int64

from vprbench.types import NO_PLACE

__all__ = ["Revisit", "metric_truth", "place_field_truth", "ranks", "revisit"]


@dataclass(frozen=True)
class Revisit:
    """How a test drive lies beside its learn drive.

    Attributes:
        nearest: (queries,) the learn frame nearest to each test frame.
        tolerance: (queries,) the distance to it, metres: d_NN.
        gaps: (queries, frames) the distance from each test frame to each learn frame, metres.
        answers: (queries, frames) the frames at which a right hypothesis must have won: those within the tolerance
            of the nearest one, {f : |f - nn(q)| <= d_NN(q)}, where |.| is in metres and nn(q) itself is always one.
    """

    nearest: Int64[np.ndarray, " queries"]
    tolerance: Float64[np.ndarray, " queries"]
    gaps: Float64[np.ndarray, "queries frames"]
    answers: Bool[np.ndarray, "queries frames"]


def revisit(learn: Float64[np.ndarray, "frames 2"], test: Float64[np.ndarray, "queries 2"]) -> Revisit:
    """Compare the positions of two drives, metres."""
    gaps = np.linalg.norm(test[:, None] - learn[None], axis=2)
    nearest = gaps.argmin(axis=1)
    tolerance = gaps[np.arange(len(test)), nearest]
    along = np.linalg.norm(learn[nearest][:, None] - learn[None], axis=2)
    return Revisit(nearest, tolerance, gaps, along <= tolerance[:, None])


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
    """Which places are right for each query by distance alone: within half a sampling distance plus d_NN."""
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
