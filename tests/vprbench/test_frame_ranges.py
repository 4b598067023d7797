from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.frame_ranges import FrameRun, format_ranges


def test_neighbours_become_a_run() -> None:
    assert format_ranges([5, 3, 6, 7, 7, 10, 11]) == "3, 5-7, 10-11"
    assert format_ranges([]) == ""


@given(st.frozensets(st.integers(0, 60)))
def test_the_text_says_each_frame_once_and_no_other(frames: frozenset[int]) -> None:
    runs = [[int(end) for end in part.split("-")] for part in format_ranges(frames).split(", ") if part]
    spelt = [frame for run in runs for frame in range(run[0], run[-1] + 1)]
    assert spelt == sorted(frames)
    assert all(after[0] > before[-1] + 1 for before, after in pairwise(runs))


@given(st.from_regex(r"[0-9a-z_]{1,8}", fullmatch=True), st.integers(0, 999_899), st.integers(1, 100))
def test_a_run_reads_back_as_it_is_written(sequence: str, first: int, count: int) -> None:
    run = FrameRun(sequence, first, first + count)
    assert FrameRun.parse(str(run)) == run
    assert len(run.frames) == count + 1


@pytest.mark.parametrize("text", ["0-10", "00:0", "00:10-2", "00:3-3", "00: 1-2", "00:-1-2", "00:1-2,4-5", ":1-2", ""])
def test_anything_else_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"is not \"sequence:first-last\"|ends before"):
        FrameRun.parse(text)


def test_a_slip_of_the_key_does_not_fill_the_memory() -> None:
    with pytest.raises(ValueError, match="'00:0-1000000' goes on after frame 999999"):
        FrameRun.parse("00:0-1000000")
    with pytest.raises(ValueError, match=r"is not \"sequence:first-last\""):
        FrameRun.parse("00:0-" + "9" * 5000)
