"""Trees in KITTI's layouts, read back with nothing but numpy and OpenCV, and with the project's own readers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from vprbench.errors import ConfigError, DataError
from vprbench.frame_ranges import FrameRun
from vprbench.readers.kitti import OdometrySequence
from vprbench.readers.kitti_raw import RawDrive
from vprbench.route import Route
from vprbench.street import StreetParameters, draw_kitti, draw_kitti_raw, street_route

LEARN, TEST = range(3, 8), range(20, 24)


@pytest.fixture(scope="module")
def route() -> Route:
    return street_route(StreetParameters("wide", 20.0), name="small")


@pytest.fixture(scope="module")
def odometry(route: Route, tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("odometry")
    draw_kitti(root, "07", {LEARN: route.learn, TEST: route.test})
    return root


def test_poses_say_where_the_vehicle_was(route: Route, odometry: Path) -> None:
    poses = np.loadtxt(odometry / "dataset" / "poses" / "07.txt").reshape(-1, 3, 4)
    times = np.loadtxt(odometry / "dataset" / "sequences" / "07" / "times.txt")
    assert len(poses) == len(times) == TEST[-1] + 1
    assert np.diff(times) == pytest.approx(0.1)
    rotations = poses[:, :, :3]
    assert rotations @ rotations.transpose(0, 2, 1) == pytest.approx(np.tile(np.eye(3), (len(poses), 1, 1)))
    for frames, traverse in ((LEARN, route.learn), (TEST, route.test)):
        here = poses[frames.start : frames.stop]
        assert here[:, [0, 2], 3] == pytest.approx(traverse.positions[: len(frames)], abs=1e-6)
        assert np.arctan2(here[:, 0, 2], here[:, 2, 2]) == pytest.approx(traverse.headings[: len(frames)], abs=1e-6)


def test_frames_between_the_drives_have_poses_on_a_straight_line(odometry: Path) -> None:
    places = np.loadtxt(odometry / "dataset" / "poses" / "07.txt").reshape(-1, 3, 4)[:, [0, 2], 3]
    steps = np.diff(places[LEARN[-1] : TEST[0] + 1], axis=0)
    assert steps == pytest.approx(np.tile(steps[0], (len(steps), 1)), abs=1e-5)


def test_pictures_are_of_kittis_size_and_only_those_asked_for(route: Route, odometry: Path) -> None:
    files = sorted((odometry / "dataset" / "sequences" / "07" / "image_0").iterdir())
    assert [int(file.stem) for file in files] == [*LEARN, *TEST]
    picture = cv2.imread(str(files[0]), cv2.IMREAD_UNCHANGED)
    assert picture is not None
    assert picture.shape == (376, 1241)
    small = cv2.resize(picture, (642, 188), interpolation=cv2.INTER_AREA).astype(float)
    assert np.abs(small - route.learn.frames[0]).mean() < 4


def test_our_reader_finds_the_same_drive(route: Route, odometry: Path) -> None:
    read = OdometrySequence(odometry, "07").traverse(FrameRun("07", LEARN[0], LEARN[-1]))
    assert read.positions == pytest.approx(route.learn.positions[:5], abs=1e-6)
    assert read.headings == pytest.approx(route.learn.headings[:5], abs=1e-6)
    assert (read.camera.fx, read.camera.cx) == pytest.approx((route.learn.camera.fx, route.learn.camera.cx))


def test_a_raw_recording_has_fixes_in_kittis_convention(route: Route, tmp_path: Path) -> None:
    folder = draw_kitti_raw(tmp_path, "2011_10_03_drive_0099", route.test, first=2, size=(642, 188))
    fixes = np.array([np.loadtxt(file) for file in sorted((folder / "oxts" / "data").iterdir())])
    assert fixes.shape == (len(route.test), 30)
    assert fixes[:, :2] == pytest.approx(route.test.geodetic, abs=1e-12)
    # Yaw is counter-clockwise from east, heading clockwise from north: both give one direction.
    assert np.cos(fixes[:, 5]) == pytest.approx(np.sin(route.test.headings))
    assert np.sin(fixes[:, 5]) == pytest.approx(np.cos(route.test.headings))
    assert len((folder / "image_00" / "timestamps.txt").read_text().splitlines()) == len(route.test) + 2


def test_our_raw_reader_finds_the_same_drive(route: Route, tmp_path: Path) -> None:
    draw_kitti_raw(tmp_path, "2011_10_03_drive_0099", route.test, size=(642, 188))
    run = FrameRun("2011_10_03_drive_0099", 0, len(route.test) - 1)
    read = RawDrive(tmp_path, run.sequence).traverse(run, np.zeros(2))
    assert read.positions == pytest.approx(route.test.positions, abs=1e-3)
    assert read.headings == pytest.approx(route.test.headings)
    assert read.times == pytest.approx(route.test.times)
    assert all(np.array_equal(read.frames[i], route.test.frames[i]) for i in (0, 3))


@pytest.mark.parametrize("numbers", [range(0), range(-1, 2), range(1000)])
def test_numbers_that_fit_no_drive_are_refused(route: Route, tmp_path: Path, numbers: range) -> None:
    with pytest.raises(ConfigError, match="cannot be numbered"):
        draw_kitti(tmp_path, "00", {numbers: route.learn})


def test_two_drives_cannot_share_a_number(route: Route, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="another drive"):
        draw_kitti(tmp_path, "00", {range(5): route.learn, range(4, 8): route.test})


def test_what_is_missing_is_said(route: Route, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no drives"):
        draw_kitti(tmp_path, "00", {})
    with pytest.raises(DataError, match="no latitude"):
        draw_kitti_raw(tmp_path, "2011_10_03_drive_0001", replace(route.learn, geodetic=None))
