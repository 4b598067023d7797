from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from vprbench.errors import DataError
from vprbench.frame_ranges import FrameRun
from vprbench.readers.images import read_grey
from vprbench.readers.kitti import OdometrySequence, read_motion, read_projection
from vprbench.truth import revisit

LEARN = FrameRun("00", 2, 9)


def poses_file(root: Path) -> Path:
    return root / "dataset" / "poses" / "00.txt"


def edit(path: Path, line: int, change: Callable[[str], str]) -> None:
    """Change one line of a file, counted from 1."""
    lines = path.read_text().splitlines()
    lines[line - 1] = change(lines[line - 1])
    path.write_text("\n".join(lines) + "\n")


def test_a_drive_has_the_motion_of_its_frames(odometry_tree: Path) -> None:
    drive = OdometrySequence(odometry_tree, "00").traverse(FrameRun("00", 15, 24))
    assert drive.positions == pytest.approx(np.stack([np.ones(10), np.arange(10.0)], axis=1))
    assert drive.headings == pytest.approx(np.zeros(10))
    assert drive.times == pytest.approx(np.arange(1.5, 2.5, 0.1))
    assert drive.indices.tolist() == list(range(15, 25))
    assert drive.geodetic is None


def test_headings_turn_clockwise_from_z(tmp_path: Path) -> None:
    turn = np.linspace(-3.0, 3.0, 13)
    zeros, ones = np.zeros(13), np.ones(13)
    rows = [np.cos(turn), zeros, np.sin(turn), zeros, zeros, ones, zeros, zeros, -np.sin(turn), zeros, np.cos(turn)]
    np.savetxt(tmp_path / "poses.txt", np.stack([*rows, zeros], axis=1))
    np.savetxt(tmp_path / "times.txt", np.arange(13.0))
    assert read_motion(tmp_path / "poses.txt", tmp_path / "times.txt").headings == pytest.approx(turn)


@pytest.mark.parametrize("folder", ["", "dataset"])
def test_the_root_may_be_the_dataset_folder(odometry_tree: Path, folder: str) -> None:
    assert len(OdometrySequence(odometry_tree / folder, "00").traverse(LEARN)) == 8


def test_each_camera_has_its_own_images_and_calibration(odometry_tree: Path) -> None:
    grey = OdometrySequence(odometry_tree, "00").traverse(LEARN)
    colour = OdometrySequence(odometry_tree, "00", "image_2").traverse(LEARN)
    assert (grey.camera.fx, grey.camera.cx) == pytest.approx((71.8 * 642 / 124, 60.7 * 642 / 124))
    assert (colour.camera.fx, colour.camera.cx) == pytest.approx((72.5 * 642 / 124, 61.5 * 642 / 124))
    assert not np.array_equal(grey.frames[0], colour.frames[0])
    assert grey.checksum != colour.checksum


def test_frames_are_read_only_when_asked_for(odometry_tree: Path) -> None:
    drive = OdometrySequence(odometry_tree, "00").traverse(LEARN)
    drive.frames[3]
    (odometry_tree / "dataset/sequences/00/image_0/000005.png").unlink()
    with pytest.raises(DataError, match=r"000005\.png: cannot be read"):
        drive.frames[3]


def test_the_checksum_sees_every_byte_of_its_own_frames(odometry_tree: Path) -> None:
    def checksum() -> str:
        return OdometrySequence(odometry_tree, "00").traverse(LEARN).checksum

    images = odometry_tree / "dataset/sequences/00/image_0"
    before = checksum()
    (images / "000010.png").write_bytes((images / "000011.png").read_bytes())
    assert checksum() == before
    (images / "000009.png").write_bytes((images / "000011.png").read_bytes())
    changed = checksum()
    assert changed != before
    edit(poses_file(odometry_tree), 5, lambda line: line.replace("4.000000e+00", "4.000001e+00"))
    assert checksum() not in (before, changed)


@pytest.mark.parametrize(
    ("line", "change", "fault"),
    [
        (7, lambda line: line + " 1", "line 7: 13 numbers where 12 are due"),
        (7, lambda line: "", "line 7: 0 numbers where 12 are due"),
        (7, lambda line: line.replace("1 0 0", "nan 0 0", 1), "line 7: 'nan' is not a finite number"),
        (29, lambda line: line.replace("1 0 0", "1 0 inf", 1), "line 29: 'inf' is not a finite number"),
        (3, lambda line: line.replace("1 0 0", "1 O 0", 1), "line 3: 'O' is not a finite number"),
        (1, lambda line: line.replace("1 0 0", "1,0 0 0", 1), "line 1: '1,0' is not a finite number"),
    ],
)
def test_a_bad_pose_is_met_by_its_line(
    odometry_tree: Path, line: int, change: Callable[[str], str], fault: str
) -> None:
    edit(poses_file(odometry_tree), line, change)
    with pytest.raises(DataError, match=rf"poses.00\.txt, {fault}"):
        OdometrySequence(odometry_tree, "00").traverse(LEARN)


def test_poses_and_times_must_be_as_many(odometry_tree: Path) -> None:
    lines = poses_file(odometry_tree).read_text().splitlines()
    poses_file(odometry_tree).write_text("\n".join(lines[:20]))
    with pytest.raises(DataError, match=r"times\.txt: 30 times for the 20 poses in .*00\.txt"):
        OdometrySequence(odometry_tree, "00").traverse(LEARN)


def test_a_run_must_end_within_its_sequence(odometry_tree: Path) -> None:
    with pytest.raises(DataError, match=r"00\.txt: 30 poses, too few for frame 30"):
        OdometrySequence(odometry_tree, "00").traverse(FrameRun("00", 2, 30))


def test_an_empty_or_binary_pose_file_is_refused(odometry_tree: Path) -> None:
    poses_file(odometry_tree).write_bytes(b"")
    with pytest.raises(DataError, match=r"00\.txt: the file is empty"):
        OdometrySequence(odometry_tree, "00").traverse(LEARN)
    poses_file(odometry_tree).write_bytes(b"\xff\xfe \x80" * 4 + b"\n")
    with pytest.raises(DataError, match=r"00\.txt, line 1: "):
        OdometrySequence(odometry_tree, "00").traverse(LEARN)


def test_times_must_increase(odometry_tree: Path) -> None:
    edit(odometry_tree / "dataset/sequences/00/times.txt", 12, lambda line: "1.0")
    with pytest.raises(DataError, match=r"times\.txt, line 12: the time is not after the one before"):
        OdometrySequence(odometry_tree, "00").traverse(LEARN)


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("P1: 1 2 3\n", r"no line 'P0'"),
        ("P1: 1\nP0: 1 2 3\n", r", line 2: not the 12 numbers of a projection matrix"),
        ("P0: nan 0 1 0 0 1 1 0 0 0 1 0\n", r", line 1: the focal length must be finite and positive"),
        ("P0: -5 0 1 0 0 1 1 0 0 0 1 0\n", r", line 1: the focal length must be finite and positive"),
    ],
)
def test_a_bad_calibration_is_refused(tmp_path: Path, text: str, fault: str) -> None:
    (tmp_path / "calib.txt").write_text(text)
    with pytest.raises(DataError, match=fault):
        read_projection(tmp_path / "calib.txt", "P0")


def test_what_is_missing_is_found_by_listing(odometry_tree: Path) -> None:
    sequence = OdometrySequence(odometry_tree, "00")
    assert sequence.need(range(30)).complete
    (odometry_tree / "dataset/sequences/00/calib.txt").unlink()
    need = sequence.need(range(25, 35))
    assert need.frames == tuple(range(25, 35))
    assert need.missing == tuple(range(30, 35))
    assert [path.name for path in need.absent] == ["calib.txt"]


# Sequence, learn and test drive; lengths; mean, sd and maximum of the distance to the nearest learn frame, metres.
PAPER = [
    ("00", (392, 932), (3399, 3839), (380.7, 381.9), (0.53, 0.36, 1.99)),
    ("05", (10, 116), (2420, 2511), (97.8, 92.1), (0.50, 0.44, 2.59)),
    ("05", (550, 780), (1289, 1554), (200.8, 219.5), (1.35, 2.09, 9.49)),
]


@pytest.mark.kitti
@pytest.mark.parametrize(("sequence", "learn", "test", "lengths", "nearest"), PAPER)
def test_the_papers_routes_have_their_published_size(
    kitti_root: Path,
    sequence: str,
    learn: tuple[int, int],
    test: tuple[int, int],
    lengths: tuple[float, float],
    nearest: tuple[float, float, float],
) -> None:
    positions = OdometrySequence(kitti_root, sequence).motion.positions
    drives = [positions[first : last + 1] for first, last in (learn, test)]
    driven = [float(np.linalg.norm(np.diff(drive, axis=0), axis=1).sum()) for drive in drives]
    gaps = revisit(*drives).tolerance
    assert driven == pytest.approx(lengths, abs=0.05)
    assert (gaps.mean(), gaps.std(), gaps.max()) == pytest.approx(nearest, abs=0.005)


@pytest.mark.kitti
def test_real_poses_head_along_their_road(kitti_root: Path) -> None:
    drive = OdometrySequence(kitti_root, "00").traverse(FrameRun("00", 113, 205))
    step = np.diff(drive.positions, axis=0)
    course = np.arctan2(step[:, 0], step[:, 1])
    assert np.degrees(np.abs(course - drive.headings[1:])).max() < 10.0
    assert drive.camera.fx == pytest.approx(718.856 * 642 / 1241)
    assert 2 * np.degrees(np.arctan(321 / drive.camera.fx)) == pytest.approx(82.0, abs=1.0)
    full = read_grey(kitti_root / "dataset/sequences/00/image_0/000113.png")
    assert full.shape == (376, 1241)
    assert drive.frames[0].mean() == pytest.approx(full.mean(), abs=0.2)
