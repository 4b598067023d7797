"""A road through a city: real landmarks in places that are new."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from vprbench.agents import build_encoder
from vprbench.errors import DataError
from vprbench.frequency.rehearsal import Rehearsal
from vprbench.observation import Drive
from vprbench.route import Route
from vprbench.scale.city import SPACING, STREET, City, road_headings
from vprbench.types import Landmarks


def test_landmarks_are_real_ones_at_real_points_and_no_two_places_are_the_same(toy_route: Route) -> None:
    rehearsal = Rehearsal(build_encoder("log-polar-6"))
    route = replace(toy_route, training=[], learn=toy_route.test)
    city = City(route, rehearsal, 50)
    real = [rehearsal.encode(seen["frame"]) for seen in Drive(toy_route.test)]
    known = {row.tobytes() for found in real for row in found.signatures}
    points = {found.points.tobytes() for found in real}
    made = [city[index].landmarks for index in range(50)]
    assert all(found is not None for found in made)
    assert {row.tobytes() for found in made if found for row in found.signatures} <= known
    assert {found.points.tobytes() for found in made if found} <= points
    assert len({found.signatures.tobytes() for found in made if found}) == 50


def test_without_an_encoder_frames_are_put_together_from_two(toy_route: Route) -> None:
    city = City(toy_route, None, 20)
    drives = (toy_route.learn, *toy_route.training, toy_route.test)
    real = [seen["frame"] for drive in drives for seen in Drive(drive)]
    for index in range(20):
        place = city[index]
        frame = place.observation["frame"]
        assert place.landmarks is None
        left = max(int(np.argmin([*(frame == one).all(axis=0).tolist(), False])) for one in real)
        assert any(np.array_equal(frame[:, left:], other[:, left:]) for other in real)
    assert len({city[index].observation["frame"].tobytes() for index in range(20)}) == 20


def test_a_place_stays_what_it_is_and_lies_on_the_road(toy_route: Route) -> None:
    one, again, other = City(toy_route, None, 9), City(toy_route, None, 9), City(toy_route, None, 9, seed=1)
    for index in range(9):
        seen: Any = one[index].observation
        same: Any = again[index].observation
        assert all(np.array_equal(seen[key], same[key]) for key in seen)
        assert seen["gps"].tolist() == [0, SPACING * index]
        assert seen["heading"] == one.headings[index]
    assert not np.array_equal(one.headings, other.headings)


def test_a_query_stands_where_the_road_leads(toy_route: Route) -> None:
    city, seen = City(toy_route, None, 9), Drive(toy_route.test, gps=False)[3]
    asked = [city.query(seen, number) for number in range(200)]
    assert {float(query["heading"][0]) for query in asked} == set(city.headings.tolist())
    assert all(query["frame"] is seen["frame"] and "gps" not in query for query in asked)


def test_a_road_turns_a_quarter_at_corners_and_comes_to_all_directions() -> None:
    headings = road_headings(100_000, 0)
    assert np.abs(headings).max() <= np.pi
    turns = np.abs((np.diff(headings) + np.pi) % (2 * np.pi) - np.pi)
    corners = turns > np.radians(45)
    assert corners.mean() == pytest.approx(SPACING / STREET, rel=0.05)
    np.testing.assert_allclose(turns[corners], np.pi / 2, atol=np.radians(6))
    assert np.histogram(headings, 8, (-np.pi, np.pi))[0].min() > 100_000 / 8 / 2


def test_of_no_landmarks_no_city_is_made(toy_route: Route) -> None:
    class Blind:
        def encode(self, frame: object) -> Landmarks:
            return Landmarks(np.empty((0, 4), np.float32), np.empty((0, 2), np.float32))

    with pytest.raises(DataError, match="finds no landmarks"):
        City(toy_route, Rehearsal(Blind()), 5)  # type: ignore[arg-type]
