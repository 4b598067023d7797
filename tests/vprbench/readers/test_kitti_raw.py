from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from vprbench.errors import DataError
from vprbench.frame_ranges import FrameRun
from vprbench.readers.kitti_raw import RawDrive, raw_run

DRIVE = "2011_10_03_drive_0027"
LEARN, TEST = FrameRun(DRIVE, 0, 14), FrameRun(DRIVE, 15, 29)
ORIGIN = np.array([49.0, 8.4])


def oxts(root: Path, frame: int) -> Path:
    return root / "2011_10_03" / f"{DRIVE}_sync" / "oxts" / "data" / f"{frame:010d}.txt"


def test_fixes_become_metres_about_the_origin(raw_tree: Path) -> None:
    drive = RawDrive(raw_tree, DRIVE).traverse(TEST, ORIGIN)
    assert drive.positions == pytest.approx(np.stack([np.ones(15), np.arange(15.0)], axis=1), abs=1e-3)
    assert drive.headings == pytest.approx(np.zeros(15))
    assert drive.geodetic is not None
    assert drive.geodetic[0] == pytest.approx([49.0, 8.4], abs=2e-5)


def test_times_are_seconds_since_the_drives_first_frame(raw_tree: Path) -> None:
    assert RawDrive(raw_tree, DRIVE).traverse(TEST, ORIGIN).times == pytest.approx(np.arange(1.5, 3.0, 0.1), abs=1e-9)


def test_the_camera_is_the_days(raw_tree: Path) -> None:
    camera = RawDrive(raw_tree, DRIVE).traverse(LEARN, ORIGIN).camera
    assert (camera.fx, camera.cx) == pytest.approx((71.8 * 642 / 124, 60.7 * 642 / 124))


def test_a_frame_without_image_or_fix_is_missing(raw_tree: Path) -> None:
    drive = RawDrive(raw_tree, DRIVE)
    assert drive.need(LEARN.frames).complete
    oxts(raw_tree, 3).unlink()
    (raw_tree / "2011_10_03" / f"{DRIVE}_sync" / "image_00" / "data" / "0000000007.png").unlink()
    assert drive.need(LEARN.frames).missing == (3, 7)


def test_a_fix_without_its_numbers_is_refused(raw_tree: Path) -> None:
    oxts(raw_tree, 3).write_text("49.0 8.4 112.8\n")
    with pytest.raises(DataError, match=r"0000000003\.txt, line 1: 3 numbers where 30 are due"):
        RawDrive(raw_tree, DRIVE).traverse(LEARN, ORIGIN)


def test_a_fix_off_the_globe_is_refused(raw_tree: Path) -> None:
    oxts(raw_tree, 3).write_text(" ".join(["490.0", "8.4", *["0"] * 28]))
    with pytest.raises(DataError, match=r"0000000003\.txt: latitude 490 is not within 90 degrees"):
        RawDrive(raw_tree, DRIVE).traverse(LEARN, ORIGIN)


def test_two_fixes_in_one_file_are_refused(raw_tree: Path) -> None:
    text = oxts(raw_tree, 3).read_text()
    oxts(raw_tree, 3).write_text(text + text)
    with pytest.raises(DataError, match=r"0000000003\.txt: 2 lines where one is due"):
        RawDrive(raw_tree, DRIVE).traverse(LEARN, ORIGIN)


@pytest.mark.parametrize(
    ("line", "text", "fault"),
    [
        (4, "noon", "line 4: 'noon' is not a time"),
        (4, "2011-10-03 12:54:00.1", "line 4: the time is not after the one before"),
        (4, "", "line 4: '' is not a time"),
    ],
)
def test_a_bad_timestamp_is_met_by_its_line(raw_tree: Path, line: int, text: str, fault: str) -> None:
    stamps = RawDrive(raw_tree, DRIVE).timestamps
    lines = stamps.read_text().splitlines()
    lines[line - 1] = text
    stamps.write_text("\n".join(lines))
    with pytest.raises(DataError, match=rf"timestamps\.txt, {fault}"):
        RawDrive(raw_tree, DRIVE).traverse(LEARN, ORIGIN)


def test_too_few_timestamps_are_refused(raw_tree: Path) -> None:
    with pytest.raises(DataError, match=r"timestamps\.txt: 30 lines, too few for frame 30"):
        RawDrive(raw_tree, DRIVE)._times(FrameRun(DRIVE, 29, 30))


@pytest.mark.parametrize(
    ("odometry", "raw"),
    [
        ("00:392-932", "2011_10_03_drive_0027:392-932"),
        ("05:0-9", "2011_09_30_drive_0018:0-9"),
        ("08:0-4070", "2011_09_30_drive_0028:1100-5170"),
        ("2011_09_30_drive_0028:5-9", "2011_09_30_drive_0028:5-9"),
    ],
)
def test_odometry_frames_are_found_in_their_raw_drive(odometry: str, raw: str) -> None:
    assert str(raw_run(FrameRun.parse(odometry))) == raw


def test_frames_beyond_the_sequence_are_refused() -> None:
    with pytest.raises(ValueError, match='"08:0-4071" goes on after the last frame of the sequence, 4070'):
        raw_run(FrameRun("08", 0, 4071))


@pytest.mark.kitti
@pytest.mark.parametrize("sequence", [f"{n:02d}" for n in range(11)])
def test_every_sequence_is_as_long_as_its_part_of_the_drive(kitti_root: Path, sequence: str) -> None:
    poses = (kitti_root / "dataset" / "poses" / f"{sequence}.txt").read_text().splitlines()
    assert raw_run(FrameRun(sequence, 0, len(poses) - 1))
    with pytest.raises(ValueError, match="goes on after"):
        raw_run(FrameRun(sequence, 0, len(poses)))
