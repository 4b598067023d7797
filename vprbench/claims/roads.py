"""What can be measured of the paper's roads: lengths and distances, from KITTI's pose files alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from jaxtyping import Float64

from vprbench.catalogue import catalogue
from vprbench.claims.reading import Evidence, Measurement, Reading, Untestable
from vprbench.data_root import data_root
from vprbench.entries.kitti import KittiOdometryEntry
from vprbench.errors import DataError
from vprbench.readers.kitti import OdometrySequence
from vprbench.truth import revisit

__all__ = ["NearestDistance", "RouteLength"]

Positions = Float64[np.ndarray, "n 2"]


class RouteLength(Measurement):
    """The length of a learn drive, metres."""

    kind: Literal["route-length"]

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The length of the claim's only route."""
        (route,) = routes
        learn, test = map(_length, _drives(evidence, route))
        return Reading(learn, learn, learn, f"poses of {route}, learn drive", remark=f"test drive {test:.1f} m")


class NearestDistance(Measurement):
    """How far test frames lie from the nearest learn frame, metres, averaged over routes.

    Attributes:
        statistic: of each route: the mean, or the standard deviation.
    """

    kind: Literal["nearest-distance"]
    statistic: Literal["mean", "sd"]

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The statistic, averaged over the claim's routes."""
        gaps = [revisit(*_drives(evidence, route)).tolerance for route in routes]
        of = np.mean if self.statistic == "mean" else np.std
        value, pooled = float(np.mean([of(gap) for gap in gaps])), float(of(np.concatenate(gaps)))
        remark = f"over all frames at once {pooled:.2f} m"
        return Reading(value, value, value, f"poses of {', '.join(routes)}", remark=remark)


def _drives(evidence: Evidence, route: str) -> tuple[Positions, Positions]:
    """Positions along the learn and the test drive of a KITTI route; its frames need not be there."""
    entry = catalogue().entry(route)
    if not isinstance(entry, KittiOdometryEntry):
        raise Untestable(f"{route} is no route of KITTI's odometry benchmark")
    try:
        motion = OdometrySequence(data_root(evidence.data), entry.learn.sequence).motion
    except DataError as error:
        raise Untestable(f"no poses of {route}: {error}") from error
    learn, test = (motion.positions[run.first : run.last + 1] for run in (entry.learn, entry.test))
    return learn, test


def _length(positions: Positions) -> float:
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=1).sum())
