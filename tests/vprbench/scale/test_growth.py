"""Growing one agent: what it holds, what is timed, and what stops it."""

from __future__ import annotations

import re
from typing import Any, ClassVar

import numpy as np
import pytest

from vprbench.agents import build_encoder
from vprbench.errors import PluginError
from vprbench.frequency.rehearsal import Rehearsal
from vprbench.frequency.subjects import Agent, fitted
from vprbench.observation import Drive
from vprbench.protocols import Recruiting
from vprbench.route import Route
from vprbench.scale.city import City
from vprbench.scale.growth import Limits, grow
from vprbench.scale.table import COLUMNS, scale_table
from vprbench.types import Observation, Responses

FREE = Limits(np.inf, np.inf)


class Hoard:
    """A localizer that keeps a megabyte a place, and says how it was asked."""

    recruiting: ClassVar[Recruiting] = "vigilance"

    def __init__(self, encoder: Rehearsal, most: int = 10**9) -> None:
        self.encoder, self.most = encoder, most
        self.learned: list[int] = []

    def fit(self, drives: object) -> None: ...

    def clear(self, sampling: float) -> None:
        self.vigilance, self.places = sampling, list[np.ndarray]()

    def learn(self, observation: Observation) -> int | None:
        self.learned.append(len(self.places))
        return None if len(self.places) >= self.most else self.store(self.describe(observation))

    def respond(self, observation: Observation) -> Responses:
        return np.zeros(len(self.places), np.float32)

    def describe(self, observation: Observation) -> np.ndarray:
        return np.resize(self.encoder.encode(observation["frame"]).signatures.astype(np.float64), 125_000)

    def store(self, description: np.ndarray) -> int:
        self.places.append(description)
        return len(self.places) - 1

    def compare(self, queries: Any, places: Any) -> Any:  # noqa: ANN401
        raise NotImplementedError


def hoard(most: int = 10**9) -> Agent:
    rehearsal = Rehearsal(build_encoder("log-polar-6"))
    return Agent("hoard", Hoard(rehearsal, most), rehearsal)


def queries(route: Route, count: int) -> list[Observation]:
    return Drive(route.test, gps=False)[:count]


def test_each_size_has_its_places_and_the_last_ones_are_learned(toy_route: Route) -> None:
    agent = hoard()
    city = City(toy_route, agent.rehearsal, 20)
    sizes = list(grow(agent, city, queries(toy_route, 4), [5, 20], FREE))
    localizer: Any = agent.localizer
    assert [size.places for size in sizes] == [5, 20]
    assert localizer.learned == [2, 3, 4, 17, 18, 19]
    for place, kept in enumerate(localizer.places):
        landmarks = city[place].landmarks
        assert landmarks is not None
        np.testing.assert_array_equal(kept, np.resize(landmarks.signatures, 125_000))
    for size in sizes:
        assert size.held == pytest.approx(1e6 * size.places, rel=0.01)
        assert len(size.visits) == 4
        assert size.added > 0
        assert not size.stopped


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        (Limits(0.0101, np.inf), r"would hold 0\.011\d* GB of places, above 0\.0101 GB"),
        (Limits(np.inf, 1e-9), r"would take \S+ s a query, above 1e-09 s"),
    ],
)
def test_a_limit_stops_it_before_the_next_size(toy_route: Route, limits: Limits, said: str) -> None:
    agent = hoard()
    sizes = list(grow(agent, City(toy_route, agent.rehearsal, 30), queries(toy_route, 1), [5, 11, 30], limits))
    assert [size.places for size in sizes] == [5, 11]
    assert not sizes[0].stopped
    assert re.fullmatch(said, sizes[1].stopped)
    localizer: Any = agent.localizer
    assert len(localizer.places) == 5
    table = scale_table("Toy", {"hoard": sizes})
    assert tuple(table.columns) == COLUMNS
    assert table["stopped"].tolist() == ["", sizes[1].stopped]
    assert table["bytes_per_place"][0] == pytest.approx(1e6, rel=0.01)
    assert np.isnan(table["query_ms"][1])


def test_one_that_takes_no_new_place_is_told_of(toy_route: Route) -> None:
    agent = hoard(most=3)
    with pytest.raises(PluginError, match="hoard: makes no place of what it is shown"):
        list(grow(agent, City(toy_route, agent.rehearsal, 9), queries(toy_route, 1), [9], FREE))


@pytest.mark.parametrize("config", ["cohog", {"localizer": "max-pi", "encoder": "log-polar-6"}], ids=str)
def test_ours_answer_as_after_learning_place_by_place(config: Any, toy_route: Route) -> None:  # noqa: ANN401
    agent = fitted("ours", config, 0, toy_route.training)
    city, (query,) = City(toy_route, agent.rehearsal, 12), queries(toy_route, 1)
    (size,) = grow(agent, city, [query], [12], FREE)
    plain = fitted("plain", config, 0, toy_route.training)
    plain.localizer.clear(1.0 if plain.localizer.recruiting == "vigilance" else 0.5)
    for index in range(12):
        seen, landmarks = city[index]
        if plain.rehearsal is None or landmarks is None:
            plain.localizer.learn(seen)
            continue
        with plain.rehearsal.recalling(landmarks):
            plain.localizer.learn(seen)
    answer = plain.localizer.respond(query)
    np.testing.assert_array_equal(agent.localizer.respond(query), answer)
    assert len(answer) == 12 == size.places
