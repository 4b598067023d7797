"""Answers chosen to be looked at, and the frames behind them."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vprbench.episode import Recording, judge
from vprbench.report.examples import pick_examples
from vprbench.report.places import place_frames
from vprbench.route import Route
from vprbench.trace import Trace
from vprbench.types import NO_PLACE


def trace(correct: list[bool], confidence: list[float], north: list[float], silent: int = 0) -> Trace:
    """A drive due north; the last `silent` queries got no answer."""
    count = len(correct)
    answered = np.arange(count) < count - silent
    right = np.array(correct) & answered
    return Trace(
        frame=np.arange(count),
        truth=np.zeros(count, np.int64),
        hypothesis=np.where(answered, 0, NO_PLACE),
        confidence=np.where(answered, confidence, 0.0),
        error_m=np.where(answered, 1.0, np.nan),
        tolerance_m=np.zeros(count),
        correct=right,
        correct_metric=right,
        rank=np.where(right, 0, NO_PLACE),
        rank_metric=np.where(right, 0, NO_PLACE),
        east=np.zeros(count),
        north=np.array(north, np.float64),
    )


def test_a_case_by_hand() -> None:
    #            0     1     2     3     4     5     6
    correct = [True, True, False, False, True, False, False]
    confidence = [0.9, 0.8, 0.95, 0.94, 0.3, 0.2, 0.0]
    north = [0.0, 5.0, 20.0, 25.0, 40.0, 60.0, 80.0]
    chosen = list(pick_examples(trace(correct, confidence, north, silent=1)))
    # 1 lies too near to 0, and 3 to 2; 5 is taken as wrong, so 4, which is taken as right, leaves 1 and 3 as uncertain.
    assert chosen == [
        ("right", 0),
        ("right", 4),
        ("wrong, though confident", 2),
        ("wrong, though confident", 5),
        ("least certain", 1),
        ("least certain", 3),
    ]


@given(st.lists(st.tuples(st.booleans(), st.integers(0, 9), st.integers(0, 200)), min_size=1, max_size=30))
def test_examples_are_what_they_are_called_and_none_comes_twice(queries: list[tuple[bool, int, int]]) -> None:
    correct, confidence, north = map(list, zip(*queries, strict=True))
    drive = trace(correct, [value / 10 for value in confidence], [float(value) for value in north])
    chosen = list(pick_examples(drive))
    assert len({index for _, index in chosen}) == len(chosen) <= 7
    assert chosen
    for kind, index in chosen:
        assert kind == "least certain" or drive.correct[index] == (kind == "right")
    for (one_kind, one), (other_kind, other) in combinations(chosen, 2):
        assert one_kind != other_kind or abs(drive.north[one] - drive.north[other]) >= 10


def test_the_frame_of_every_answered_place_is_found(toy_route: Route) -> None:
    rng, places = np.random.default_rng(3), np.array([0, 4, 9, 15, 22, 30, 38])
    responses = rng.random((len(toy_route.test), len(places)), np.float32)
    recording = Recording(places, rng.integers(0, len(places), len(toy_route.learn)), responses)
    answers = judge(toy_route, recording, 5.0)
    found = place_frames(answers, toy_route)
    assert set(found) == set(answers.hypothesis.tolist())
    assert {place: int(places[place]) for place in found} == found


def test_a_place_that_two_frames_could_be_is_not_guessed(toy_route: Route) -> None:
    # The one query lies half-way between frames 10 and 11: the place may be either.
    positions = toy_route.learn.positions
    middle = (positions[10] + positions[11]) / 2
    one = trace([False], [0.5], [0.0])
    frame = one.to_frame().assign(east=middle[0], north=middle[1], error_m=0.5)
    from dataclasses import replace

    drive = toy_route.test
    short = replace(
        drive,
        positions=middle[None],
        headings=drive.headings[:1],
        times=drive.times[:1],
        indices=drive.indices[:1],
    )
    assert place_frames(Trace.from_frame(frame), replace(toy_route, test=short)) == {}
