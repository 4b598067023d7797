from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from vprbench.data_checks.motion import motion_findings
from vprbench.readers.number_files import read_numbers
from vprbench.route import Camera, Traverse


class Black:
    def __getitem__(self, index: int) -> np.ndarray:
        return np.zeros((188, 642), np.uint8)


def drive(east: Sequence[float] | np.ndarray, times: Sequence[float] | np.ndarray) -> Traverse:
    """A drive due east whose frames are numbered from 100."""
    seconds = np.array(times, float)
    positions, still = np.column_stack([east, 0 * seconds]), 0 * seconds
    return Traverse("day1", Black(), positions, still, seconds, Camera(372.0, 321.0), np.arange(len(seconds)) + 100, "")


def test_a_steady_drive_is_in_order() -> None:
    assert list(motion_findings(drive(np.arange(50.0), np.arange(50) / 10))) == []


def test_a_car_that_stops_and_goes_is_in_order() -> None:
    speeds = np.concatenate([np.full(30, 10.0), np.zeros(40), np.linspace(0, 15, 30)])
    assert list(motion_findings(drive(np.cumsum(speeds / 10), np.arange(100) / 10))) == []


def test_times_that_run_back_are_an_error() -> None:
    (found,) = motion_findings(drive(np.arange(6.0), [0, 1, 2, 2, 4, 3]))
    assert (found.severity, found.check, found.where) == ("error", "times", "day1, frames 103, 105")
    assert found.what == "2 times are not after the one before"


def test_a_jump_is_named_by_the_frame_after_it() -> None:
    east = np.arange(50.0)
    east[20:] += 6.0
    (found,) = motion_findings(drive(east, np.arange(50) / 10))
    assert (found.severity, found.check, found.where) == ("warning", "jumps", "day1, frame 120")
    assert found.what == "a step far beyond the drive's usual speed, the longest 7.0 m"


def test_a_lost_fix_is_two_jumps() -> None:
    east = np.arange(50.0) + 1000
    east[20] = 0.0
    (found,) = motion_findings(drive(east, np.arange(50) / 10))
    assert found.where == "day1, frames 120-121"


def test_a_pause_in_the_recording_is_a_gap_and_the_way_driven_meanwhile_no_jump() -> None:
    times = np.arange(50) / 10
    times[20:] += 2.0
    (found,) = motion_findings(drive(10 * times, times))
    assert (found.check, found.where) == ("gaps", "day1, frame 120")
    assert "the longest of 2.1 s" in found.what


def test_two_frames_are_a_drive() -> None:
    assert list(motion_findings(drive([0.0, 1.0], [0.0, 0.1]))) == []


@pytest.mark.kitti
@pytest.mark.parametrize("sequence", [f"{number:02d}" for number in range(11)])
def test_no_sequence_of_kitti_jumps(kitti_root: Path, sequence: str) -> None:
    poses = read_numbers(kitti_root / "dataset" / "poses" / f"{sequence}.txt", 12)
    numbers = np.arange(len(poses))
    camera = Camera(372.0, 321.0)
    whole = Traverse(sequence, Black(), poses[:, [3, 11]], 0.0 * numbers, numbers / 10, camera, numbers, "")
    assert list(motion_findings(whole)) == []
