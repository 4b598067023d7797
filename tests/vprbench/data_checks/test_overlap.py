from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from vprbench.data_checks.overlap import overlap, overlap_findings, training_findings
from vprbench.route import Route, Traverse


def shifted(drive: Traverse, east: np.ndarray | float, heading: float = 0.0) -> Traverse:
    aside = np.column_stack([np.broadcast_to(east, len(drive)), np.zeros(len(drive))])
    return replace(drive, positions=drive.positions + aside, headings=drive.headings + heading)


def test_the_toy_route_lies_as_it_was_made(toy_route: Route) -> None:
    """Its test drive is 0.4 m aside of learn frames that are 1 m apart."""
    beside = overlap(toy_route)
    north = toy_route.test.positions[:, 1]
    assert beside.distance == pytest.approx(np.hypot(0.4, north - np.round(north)))
    assert beside.nearest.tolist() == np.round(north).astype(int).tolist()
    figures = beside.figures()
    assert figures["distance_max_m"] == pytest.approx(beside.distance.max())
    assert (figures["share_beyond_3_m"], figures["heading_max_deg"]) == (0.0, 0.0)
    assert list(overlap_findings(toy_route.test, beside)) == []


def test_frames_far_from_the_road_learned_are_counted(toy_route: Route) -> None:
    test = shifted(toy_route.test, np.where(np.arange(30) < 6, 5.0, 0.0))
    beside = overlap(replace(toy_route, test=test))
    assert beside.figures()["share_beyond_3_m"] == 0.2
    (found,) = overlap_findings(test, beside)
    assert (found.severity, found.check, found.where) == ("warning", "distance", "toy test, frames 100-105")
    assert found.what.startswith("6 of 30 frames lie beyond 3 m from the learn drive, up to 5.4")


def test_headings_are_compared_across_the_turn_of_pi(toy_route: Route) -> None:
    learn, test = shifted(toy_route.learn, 0.0, 3.1), shifted(toy_route.test, 0.0, -3.1)
    assert list(overlap_findings(test, overlap(replace(toy_route, learn=learn, test=test)))) == []


def test_a_drive_the_other_way_is_told(toy_route: Route) -> None:
    back = shifted(toy_route.test, 0.0, np.pi)
    (found,) = overlap_findings(back, overlap(replace(toy_route, test=back)))
    assert (found.check, found.where) == ("heading", "toy test, frames 100-129")
    assert found.what == "30 of 30 frames look more than 45 degrees aside of the learn drive, up to 180"


def test_training_beside_the_road_is_told(toy_route: Route) -> None:
    (elsewhere,) = toy_route.training  # 0 to 90 m along a road whose first 40 m are the route's
    (found,) = training_findings(toy_route, [elsewhere, shifted(elsewhere, 20.0)])
    assert (found.severity, found.check, found.where) == ("warning", "training", "toy training, frames 100-105")
    assert found.what == "6 of 10 frames lie within 10 m of the route"
