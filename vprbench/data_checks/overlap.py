"""How the test drive of a route lies beside its learn drive, and how far off the route it trains."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int64

from vprbench.data_checks.finding import Finding
from vprbench.data_checks.motion import frames_of
from vprbench.geodesy import wrap
from vprbench.route import Route, Traverse
from vprbench.truth import revisit

__all__ = ["AWAY", "NEAR", "Overlap", "overlap", "overlap_findings", "training_findings"]

# Metres from which on a test frame is told as far from the road learned: the paper's middle sampling distance.
AWAY = 3.0

# Metres within which a training frame sees what the route sees; those of our own routes lie farther. Our choice.
NEAR = 10.0

# Radians of heading from which on two drives see different things; a camera of KITTI sees 82 degrees. Our choice.
_TURNED = np.pi / 4


@dataclass(frozen=True)
class Overlap:
    """The test drive held against the learn drive.

    Attributes:
        nearest: (queries,) the learn frame nearest to each test frame.
        distance: (queries,) the distance to it, metres: d_NN.
        turn: (queries,) how far the heading is off that frame's, radians, 0..pi.
    """

    nearest: Int64[np.ndarray, " queries"]
    distance: Float64[np.ndarray, " queries"]
    turn: Float64[np.ndarray, " queries"]

    def figures(self) -> dict[str, float]:
        """Its statistics: metres, shares and degrees."""
        return {
            "distance_mean_m": float(self.distance.mean()),
            "distance_sd_m": float(self.distance.std()),
            "distance_max_m": float(self.distance.max()),
            "share_beyond_3_m": float((self.distance > AWAY).mean()),
            "heading_mean_deg": float(np.degrees(self.turn).mean()),
            "heading_max_deg": float(np.degrees(self.turn).max()),
        }


def overlap(route: Route) -> Overlap:
    """Compare the drives of a route."""
    visit = revisit(route.learn.positions, route.test.positions)
    turn = np.abs(wrap(route.test.headings - route.learn.headings[visit.nearest]))
    return Overlap(visit.nearest, visit.tolerance, turn)


def overlap_findings(test: Traverse, beside: Overlap) -> Iterator[Finding]:
    """Test frames far from the road learned, or looking elsewhere."""
    away = np.flatnonzero(beside.distance > AWAY)
    if away.size:
        what = f"{_share(away, test)} lie beyond {AWAY:g} m from the learn drive, up to {beside.distance.max():.2f} m"
        remedy = "report with and without them, or shorten the test drive"
        yield Finding("warning", "distance", frames_of(test, away), what, remedy)
    turned = np.flatnonzero(beside.turn > _TURNED)
    if turned.size:
        most = np.degrees(beside.turn.max())
        what = f"{_share(turned, test)} look more than 45 degrees aside of the learn drive, up to {most:.0f}"
        yield Finding("warning", "heading", frames_of(test, turned), what, "check the headings, or which way is driven")


def training_findings(route: Route, training: Sequence[Traverse]) -> Iterator[Finding]:
    """Training frames beside the route.

    Args:
        route: whose drives they should be off.
        training: those of its training drives whose positions have the route's origin.
    """
    road = np.concatenate([route.learn.positions, route.test.positions])
    for drive in training:
        near = np.flatnonzero(revisit(road, drive.positions).tolerance <= NEAR)
        if near.size:
            what = f"{_share(near, drive)} lie within {NEAR:g} m of the route"
            yield Finding("warning", "training", frames_of(drive, near), what, "leave them out, or say so with results")


def _share(rows: Int64[np.ndarray, " rows"], drive: Traverse) -> str:
    return f"{len(rows)} of {len(drive)} frames"
