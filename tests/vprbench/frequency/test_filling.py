"""A road of any length, of the frames that there are."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from vprbench.frequency.filling import Filling, told
from vprbench.observation import Drive
from vprbench.route import Route


def test_the_learn_drive_comes_first_then_the_others_then_all_again(toy_route: Route) -> None:
    filling = Filling(toy_route, 1000)
    assert len(filling) == 41 + 10 + 30
    assert told(filling[i].source for i in range(41)) == "learn 41"
    assert told(filling[i].source for i in range(60)) == "learn 41, training 10, test 9"
    assert told(filling[i].source for i in range(100)) == "learn 41, training 10, test 30, again 19"
    frames = [
        seen["frame"] for drive in (toy_route.learn, *toy_route.training, toy_route.test) for seen in Drive(drive)
    ]
    for i in (0, 40, 41, 51, 80, 81, 200):
        np.testing.assert_array_equal(filling[i].observation["frame"], frames[i % 81])
        assert filling[i].frame == i % 81


def test_every_observation_is_headed_as_the_learn_drive_and_a_metre_on(toy_route: Route) -> None:
    turned = np.linspace(-1, 1, 41)
    filling = Filling(replace(toy_route, learn=replace(toy_route.learn, headings=turned)), 1000)
    seen = [filling[i].observation for i in range(120)]
    assert [one["heading"].item() for one in seen] == [turned[i % 41] for i in range(120)]
    assert {float(np.linalg.norm(b["gps"] - a["gps"])) for a, b in pairwise(seen)} == {1.0}


def test_no_more_frames_are_read_than_are_needed(toy_route: Route) -> None:
    told: list[tuple[int, int]] = []
    filling = Filling(toy_route, 45, lambda stage, done, total, note="": told.append((done, total)))
    assert len(filling) == 45
    assert told == [(i + 1, 45) for i in range(45)]
    assert filling[45].source == "again"
