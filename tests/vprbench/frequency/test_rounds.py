"""Turns, queries, and times that are known beforehand."""

from __future__ import annotations

import gc
from collections import Counter
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from vprbench.frequency.filling import Filling
from vprbench.frequency.rounds import MOST_QUERIES, SLICE_SECONDS, play_rounds, queries_a_visit, round_queries
from vprbench.frequency.stopwatch import visit
from vprbench.frequency.subjects import Agent, Subject, subjects
from vprbench.observation import Drive
from vprbench.route import Route


class Listed:
    """A localizer that writes down who was asked, and with which frame."""

    def __init__(self, name: str, asked: list[tuple[str, int]]) -> None:
        self.name, self.asked = name, asked

    def respond(self, observation: Any) -> Any:  # noqa: ANN401
        assert self.asked is not None
        self.asked.append((self.name, observation))
        self.collecting = gc.isenabled()
        return np.zeros(1, np.float32)


def listed(names: str) -> tuple[list[Subject], list[tuple[str, int]]]:
    asked: list[tuple[str, int]] = []
    made: list[Any] = [Listed(name, asked) for name in names]
    return [Subject(one.name, 1, "", one, None) for one in made], asked


def test_each_round_visits_every_subject_once_in_an_order_of_its_own() -> None:
    those, asked = listed("abcdef")
    queries: Any = list(range(50))
    orders, frames = [], []
    for visits in play_rounds(those, queries, 6):
        assert [one.queries for one in visits] == [MOST_QUERIES] * 6
        runs = asked[-6 * (MOST_QUERIES + 1) :]
        orders.append([name for name, _ in runs[:: MOST_QUERIES + 1]])
        # The first of each visit is the uncounted one; the others are the same for all.
        ((counted, times),) = Counter(tuple(f for _, f in turn[1:]) for turn in chunks(runs)).items()
        assert times == 6
        frames.append(counted)
        assert all(turn[0][1] in counted for turn in chunks(runs))
    assert all(sorted(order) == list("abcdef") for order in orders)
    assert len({tuple(order) for order in orders}) > 3
    assert len({frame for counted in frames for frame in counted}) == 6 * MOST_QUERIES
    collecting: Any = those[0].localizer
    assert not collecting.collecting
    assert gc.isenabled()


def chunks(runs: list[tuple[str, int]]) -> list[list[tuple[str, int]]]:
    return [runs[i : i + MOST_QUERIES + 1] for i in range(0, len(runs), MOST_QUERIES + 1)]


def test_queries_come_from_all_along_the_drive_and_not_twice() -> None:
    taken = [frame for number in range(16) for frame in round_queries(number, 80)]
    assert len(taken) == 16 * MOST_QUERIES == 80
    assert len(set(taken)) > 60
    assert max(b - a for a, b in pairwise(sorted({-1, *taken[:40], 80}))) < 8
    assert set(round_queries(3, 1)) == {0}


def test_a_slow_subject_gets_fewer_queries_by_rule() -> None:
    assert queries_a_visit(SLICE_SECONDS / 1000) == MOST_QUERIES
    assert queries_a_visit(SLICE_SECONDS / 3.5) == 3
    assert queries_a_visit(10 * SLICE_SECONDS) == 1


def test_the_times_are_those_that_were_taken(ledger: Callable[..., Agent], toy_route: Route) -> None:
    few, many = subjects(ledger(encode=0.004, compare=0.001), Filling(toy_route, 10), [2, 10])
    queries = list(Drive(toy_route.test, gps=False))[:3]
    for subject, respond in ((few, 0.002), (many, 0.010)):
        # Whatever disturbs a time makes it longer: the shortest of some is nearest to the true one.
        taken = [visit(subject, queries) for _ in range(5)]
        for part, true in (("encode", 0.004), ("respond", respond), ("query", 0.004 + respond)):
            assert true <= min(getattr(one, part).wall for one in taken) < 3 * true
        assert all(one.query.cpu <= 1.2 * one.query.wall for one in taken)


def test_time_asleep_is_not_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    import time

    those, _ = listed("a")
    localizer: Any = those[0].localizer
    monkeypatch.setattr(localizer, "respond", lambda query: time.sleep(0.02))
    taken = visit(those[0], [localizer])
    assert taken.query.wall >= 0.02
    assert taken.query.cpu < 0.01
    assert np.isnan([*taken.encode, *taken.respond]).all()
