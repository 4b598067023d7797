"""Frames that jobs share: got once, never spoilt, never more than there is room for."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.frame_memory import LIMIT, FrameMemory
from vprbench.observation import Drive
from vprbench.route import Camera, Route, Traverse
from vprbench.types import Frame

FRAMES = 4  # of each drive


@dataclass
class Counted:
    """Frames that count how often each is got; frame i of drive d shows 10 d + i."""

    drive: int
    got: Counter[int] = field(default_factory=Counter)

    def __getitem__(self, index: int, /) -> Frame:
        self.got[index] += 1
        return np.full((188, 642), 10 * self.drive + range(FRAMES)[index], np.uint8)


def traverse(drive: int, checksum: str) -> Traverse:
    zeros, along = np.zeros(FRAMES), np.arange(FRAMES)
    positions = np.stack([zeros, along], axis=1)
    camera = Camera(300.0, 321.0)
    return Traverse(f"drive {drive}", Counted(drive), positions, zeros, along.astype(float), camera, along, checksum)


def road(name: str) -> Route:
    learn, test, training = (traverse(drive, f"{name}{drive}") for drive in range(3))
    return Route(name, learn, test, (training,))


def got(route: Route) -> list[int]:
    """How many frames of the learn, test and training drives were got from their source."""
    sources = (drive.frames for drive in (route.learn, route.test, *route.training))
    return [source.got.total() for source in sources if isinstance(source, Counted)]


def play(route: Route) -> None:
    """Look at every frame, and hold each to be what it is."""
    for number, drive in enumerate((route.learn, route.test, *route.training)):
        shown = [int(observation["frame"][0, 0]) for observation in Drive(drive)]
        assert shown == [10 * number + index for index in range(FRAMES)]


def test_a_route_played_again_gets_no_frame_again() -> None:
    memory, first, again = FrameMemory(), road("a"), road("a")
    play(memory.share(first))
    play(memory.share(again))
    assert (got(first), got(again)) == ([FRAMES] * 3, [0] * 3)


def test_all_but_the_frames_is_as_it_was() -> None:
    route = road("a")
    shared = FrameMemory().share(route)
    assert replace(shared.learn, frames=route.learn.frames) == route.learn
    assert [drive.name for drive in (shared.learn, shared.test, *shared.training)] == ["drive 0", "drive 1", "drive 2"]
    np.testing.assert_array_equal(shared.visit.tolerance, route.visit.tolerance)


def test_who_writes_into_a_frame_spoils_no_other() -> None:
    memory = FrameMemory()
    for _ in range(2):
        memory.share(road("a")).test.frames[1][:] = 0
    play(memory.share(road("a")))


def test_a_route_whose_data_changed_is_read_anew() -> None:
    memory, changed = FrameMemory(), road("a")
    play(memory.share(road("a")))
    changed = replace(changed, test=replace(changed.test, checksum="another"))
    play(memory.share(changed))
    assert got(changed) == [FRAMES] * 3


def test_the_route_played_longest_ago_makes_room() -> None:
    memory = FrameMemory(limit=2 * 3 * FRAMES)
    for name in "abac":  # b was played longest ago when c comes
        play(memory.share(road(name)))
    kept, forgotten = road("a"), road("b")
    play(memory.share(kept))
    play(memory.share(forgotten))
    assert (got(kept), got(forgotten)) == ([0] * 3, [FRAMES] * 3)


def test_a_route_too_large_keeps_what_fits() -> None:
    memory = FrameMemory(limit=6)
    play(memory.share(road("b")))
    for expected in ([4, 4, 4], [0, 2, 4]):
        large = road("a")
        play(memory.share(large))
        assert got(large) == expected


def test_a_frame_that_does_not_come_is_asked_for_again() -> None:
    memory, route = FrameMemory(), road("a")
    for _ in range(2):
        with pytest.raises(IndexError):
            memory.share(route).learn.frames[FRAMES]
    assert got(route) == [2, 0, 0]


@given(st.lists(st.tuples(st.sampled_from("abc"), st.integers(0, FRAMES - 1)), max_size=40), st.integers(0, 8))
def test_no_more_frames_are_kept_than_there_is_room_for(asked: list[tuple[str, int]], limit: int) -> None:
    memory = FrameMemory(limit)
    for name, index in asked:
        assert memory.share(road(name)).test.frames[index][0, 0] == 10 + index
        assert sum(map(len, memory._routes.values())) <= limit


def test_the_limit_is_256_megabytes() -> None:
    assert 2**28 - road("a").learn.frames[0].nbytes < LIMIT * road("a").learn.frames[0].nbytes <= 2**28
