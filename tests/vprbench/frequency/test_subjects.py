"""Memories that grow, a copy at each size."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from vprbench.agents import build
from vprbench.errors import PluginError
from vprbench.frequency.filling import Filling
from vprbench.frequency.subjects import Agent, Subject, fitted, subjects
from vprbench.observation import Drive
from vprbench.route import Route

SIZES = [1, 30, 41, 100]


def test_each_size_holds_so_many_places_of_the_filling(ledger: Callable[..., Agent], toy_route: Route) -> None:
    filling = Filling(toy_route, 100)
    found: list[Any] = list(subjects(ledger(), filling, SIZES))
    assert [(one.agent, one.places, len(one.localizer.places)) for one in found] == [("ledger", n, n) for n in SIZES]
    assert found[2].filled_from == "learn 41"
    assert found[3].filled_from == "learn 41, training 10, test 30, again 19"
    for one in found:
        learned = [seen["gps"][1] for seen in one.localizer.learned]
        assert learned == list(range(one.places))


def test_a_subject_stays_as_it_was_made(ledger: Callable[..., Agent], toy_route: Route) -> None:
    found: list[Any] = list(subjects(ledger(), Filling(toy_route, 10), [3, 6]))
    found[0].localizer.places.clear()
    assert [len(one.localizer.places) for one in found] == [0, 6]
    assert found[0].rehearsal is found[1].rehearsal is found[0].localizer.encoder


def test_no_frame_is_encoded_twice(ledger: Callable[..., Agent], toy_route: Route) -> None:
    agent: Any = ledger()
    assert len(list(subjects(agent, Filling(toy_route, 300), [300]))) == 1
    assert agent.rehearsal.encoder.encoded == 81


class Choosy:
    """A localizer without an encoder that takes each frame once, and cannot be copied where that is asked for."""

    recruiting = "step"

    def __init__(self, *, alone: bool = False) -> None:
        self.alone = alone

    def clear(self, sampling: float) -> None:
        self.step, self.known = sampling, set[bytes]()

    def learn(self, observation: Any) -> int | None:  # noqa: ANN401
        frame = observation["frame"].tobytes()
        if frame in self.known:
            return None
        self.known.add(frame)
        return len(self.known) - 1

    def __deepcopy__(self, memo: object) -> Any:  # noqa: ANN401
        if self.alone:
            raise TypeError("a lock\nis in it")
        other = Choosy()
        other.known = set(self.known)
        return other


def sizes_of(found: list[Subject]) -> list[int]:
    return [subject.places for subject in found]


def test_an_agent_that_makes_no_more_places_is_left_at_those_it_makes(toy_route: Route) -> None:
    choosy: Any = Choosy()
    filling = Filling(toy_route, 200)
    found = list(subjects(Agent("choosy", choosy, None), filling, [10, 50, 82, 200]))
    assert sizes_of(found) == [10, 50]
    assert choosy.known == {filling[i].observation["frame"].tobytes() for i in range(81)}
    assert 0 < choosy.step < 1


def test_a_localizer_that_cannot_be_copied_is_told_of(toy_route: Route) -> None:
    choosy: Any = Choosy(alone=True)
    assert sizes_of(list(subjects(Agent("choosy", choosy, None), Filling(toy_route, 20), [20]))) == [20]
    with pytest.raises(PluginError, match=r"choosy: its localizer cannot be copied.*TypeError: a lock is in it"):
        list(subjects(Agent("choosy", choosy, None), Filling(toy_route, 20), [10, 20]))


@pytest.mark.parametrize(
    "config", ["cohog", {"localizer": "max-pi", "encoder": "log-polar-6"}], ids=["cohog", "max-pi"]
)
def test_ours_hold_the_places_that_learning_frame_by_frame_gives(config: Any, toy_route: Route) -> None:  # noqa: ANN401
    agent = fitted("ours", config, 0, toy_route.training)
    assert (agent.rehearsal is None) == (config == "cohog")
    filling, query = Filling(toy_route, 9), Drive(toy_route.test, gps=False)[11]
    few, many, again = subjects(agent, filling, [4, 9, 20])
    plain: Any = build(config)
    plain.fit([Drive(drive) for drive in toy_route.training])
    plain.clear(1.0 if plain.recruiting == "vigilance" else 0.5)
    assert [plain.learn(filling[i].observation) for i in range(9)] == list(range(9))
    answer = plain.respond(query)
    np.testing.assert_array_equal(many.localizer.respond(query), answer)
    np.testing.assert_array_equal(few.localizer.respond(query), answer[:4])
    assert answer.max() > 0
    # With frames that it knows already, whatever it may respond to them.
    assert len(again.localizer.respond(query)) == 20
