"""The record phase against a road where every answer is known: frame k is uniformly k grey levels bright."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from vprbench.place_fields import PlaceFields, record_fields
from vprbench.protocols import DescriptorLocalizer, Recruiting
from vprbench.recruiting import Odometer
from vprbench.route import Route
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Frame, Observation, Responses

# On the toy route's learn drive, of 41 frames a metre apart, a place every 10 m.
PLACES = [0, 10, 20, 30, 40]


class Brightness:
    def __getitem__(self, index: int) -> Frame:
        return np.full((FRAME_HEIGHT, FRAME_WIDTH), index, np.uint8)


class Played:
    """A place answers 1 less a hundredth for each grey level of difference; it can only be played."""

    recruiting: ClassVar[Recruiting] = "step"

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Nothing to learn."""

    def clear(self, sampling: float) -> None:
        self.odometer, self.places = Odometer(sampling), list[float]()

    def learn(self, observation: Observation) -> int | None:
        if not self.odometer.due(observation["gps"]):
            return None
        self.places.append(float(observation["frame"][0, 0]))
        return len(self.places) - 1

    def respond(self, observation: Observation) -> Responses:
        assert "gps" not in observation
        return self.answers([float(observation["frame"][0, 0])], self.places)[0]

    def answers(self, queries: Sequence[float], places: Sequence[float]) -> np.ndarray:
        return (1 - np.abs(np.subtract.outer(queries, places)) / 100).astype(np.float32)


class Compared(Played):
    """The same from descriptions."""

    def describe(self, observation: Observation) -> float:
        return float(observation["frame"][0, 0])

    def compare(self, queries: Sequence[float], places: Sequence[float]) -> np.ndarray:
        return self.answers(queries, places)


@pytest.fixture(params=[Played, Compared])
def fields(request: pytest.FixtureRequest, toy_route: Route) -> PlaceFields:
    localizer = request.param()
    assert isinstance(localizer, DescriptorLocalizer) == (request.param is Compared)
    # Only the learn drive may be played.
    route = replace(toy_route, learn=replace(toy_route.learn, frames=Brightness()), test=toy_route.test)
    return record_fields(route, localizer, 10.0, agent="bright")


def test_every_response_along_the_learn_drive_is_recorded(fields: PlaceFields) -> None:
    assert_array_equal(fields.places, PLACES)
    expected = 1 - np.abs(np.arange(41)[:, None] - np.array(PLACES)) / 100
    assert_allclose(fields.responses, expected, atol=1e-6)
    assert_allclose(fields.distance, np.arange(41.0))
    assert_array_equal(fields.frames, np.arange(100, 141))


def test_a_field_reaches_half_way_to_the_next_place(fields: PlaceFields) -> None:
    # At equal distance from two places the earlier one wins.
    assert_array_equal(fields.winners, [(frame + 4) // 10 for frame in range(41)])


def test_the_table_has_a_row_for_each_place_and_frame(fields: PlaceFields) -> None:
    table = fields.table()
    assert len(table) == 5 * 41
    (row,) = table[(table["place"] == 2) & (table["frame"] == 117)].to_dict("records")
    assert (row["made_at_frame"], row["made_at_m"], row["distance_m"]) == (120, 20.0, 17.0)
    assert row["response"] == pytest.approx(0.97)
    assert row["wins"]
    assert table["wins"].sum() == 41
    assert set(table["route"]) == {"toy"}
    assert set(table["agent"]) == {"bright"}
