"""Frames that are read before they are asked for: the same ones, once each, and only where a drive is gone through."""

from __future__ import annotations

import copy
import os
import pickle
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from threading import Event

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.errors import DataError
from vprbench.readers.images import ImageFiles
from vprbench.readers.read_ahead import AHEAD, ReadAhead
from vprbench.types import Frame

FRAMES = 12


class Source:
    """Frames that show their number and note who was read; some cannot be."""

    def __init__(self, *broken: int) -> None:
        self.broken = broken
        self.read: list[int] = []
        self.done = [Event() for _ in range(FRAMES)]

    def __call__(self, index: int) -> Frame:
        self.read.append(index)
        self.done[index].set()
        if index in self.broken:
            raise DataError(f"frame {index} is broken")
        return np.full((188, 642), index, np.uint8)

    def wait_for(self, index: int) -> None:
        assert self.done[index].wait(30)


def shown(frame: Frame) -> int:
    return int(frame[0, 0])


@given(st.lists(st.integers(0, FRAMES - 1), max_size=30))
def test_every_frame_is_the_one_asked_for_whatever_the_order(order: list[int]) -> None:
    ahead = ReadAhead(Source(), FRAMES)
    for index in order:
        frame = ahead.get(index)
        assert shown(frame) == index
        frame[:] = 255


def test_a_drive_is_read_ahead_once_and_not_beyond_its_end() -> None:
    source = Source()
    ahead = ReadAhead(source, FRAMES)
    ahead.get(0)
    assert source.read == [0]
    ahead.get(1)
    source.wait_for(1 + AHEAD)
    assert sorted(source.read) == list(range(2 + AHEAD))
    assert [shown(ahead.get(index)) for index in range(2, FRAMES)] == list(range(2, FRAMES))
    assert sorted(source.read) == list(range(FRAMES))


def test_frames_out_of_order_are_read_when_asked_for_alone() -> None:
    source = Source()
    ahead = ReadAhead(source, FRAMES)
    assert [shown(ahead.get(index)) for index in (0, 5, 3, 9, 1)] == [0, 5, 3, 9, 1]
    assert source.read == [0, 5, 3, 9, 1]


def test_a_broken_frame_fails_when_it_is_asked_for_and_each_time() -> None:
    source = Source(3)
    ahead = ReadAhead(source, FRAMES)
    ahead.get(0)
    ahead.get(1)
    source.wait_for(3)
    ahead.get(2)
    for _ in range(2):
        with pytest.raises(DataError, match="frame 3 is broken"):
            ahead.get(3)
    assert shown(ahead.get(4)) == 4


def test_threads_that_share_a_drive_get_the_frames_they_ask_for() -> None:
    ahead = ReadAhead(Source(), FRAMES)
    orders = [np.random.default_rng(seed).integers(0, FRAMES, 200).tolist() for seed in range(4)]
    with ThreadPoolExecutor(len(orders)) as pool:
        for order, found in zip(
            orders, pool.map(lambda order: [shown(ahead.get(i)) for i in order], orders), strict=True
        ):
            assert found == order


def test_after_a_fork_nothing_is_expected_of_the_threads_left_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    ahead = ReadAhead(Source(), FRAMES)
    ahead.get(0)
    ahead.get(1)
    # What a thread was at that is gone: nobody will ever finish it.
    ahead._coming = {2: Future()}
    monkeypatch.setattr(os, "getpid", lambda: -1)
    assert shown(ahead.get(2)) == 2


def test_files_in_the_midst_of_being_read_can_be_copied(tmp_path: Path) -> None:
    paths = tuple(tmp_path / f"{number}.png" for number in range(FRAMES))
    for number, path in enumerate(paths):
        cv2.imwrite(str(path), np.full((188, 642), number, np.uint8))
    files = ImageFiles(paths, (642, 188))
    assert [shown(files[number]) for number in (0, 1)] == [0, 1]
    for other in (copy.deepcopy(files), pickle.loads(pickle.dumps(files)), files):
        assert other == files
        assert [shown(other[number]) for number in range(2, FRAMES)] == list(range(2, FRAMES))
    assert shown(files[-1]) == FRAMES - 1
