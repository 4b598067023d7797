"""Small data sets in the layouts that the readers know, written by the tests themselves."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

# A drive due north, 1 m a frame, and from frame 15 on the same road again, 1 m to the east.
FRAMES = 30
EAST = np.repeat([0.0, 1.0], 15)
NORTH = np.tile(np.arange(15.0), 2)
ORIGIN = (49.0, 8.4)
METRES_PER_DEGREE = (111_206.0, 73_134.0)  # of latitude and of longitude at 49 degrees, from the ellipsoid's radii


def write_image(path: Path, value: int, size: tuple[int, int] = (124, 38), channels: int = 1) -> None:
    """A noisy image, seeded by its value."""
    path.parent.mkdir(parents=True, exist_ok=True)
    shape = (size[1], size[0], channels) if channels > 1 else (size[1], size[0])
    assert cv2.imwrite(str(path), np.random.default_rng(value).integers(0, 256, shape, np.uint8))


def write_view(path: Path, step: int, size: tuple[int, int] = (160, 48), seed: int = 7) -> None:
    """A window onto a long random wall, `step` times 12 pixels along it: near steps look alike, far ones do not."""
    coarse = np.random.default_rng(seed).integers(0, 256, (12, 300), np.uint8)
    wall = cv2.resize(coarse, (2400, size[1]), interpolation=cv2.INTER_CUBIC)
    path.parent.mkdir(parents=True, exist_ok=True)
    assert cv2.imwrite(str(path), wall[:, 12 * step : 12 * step + size[0]])


def projection(fx: float, cx: float) -> str:
    """A projection matrix as KITTI writes it."""
    return f"{fx:e} 0 {cx:e} 0 0 {fx:e} 18 0 0 0 1 0"


@pytest.fixture
def draw_noise() -> Callable[..., None]:
    """Write a noisy image: path, value, size, channels."""
    return write_image


@pytest.fixture
def draw_view() -> Callable[..., None]:
    """Write a view of one long wall: path, step along it, size, seed of the wall."""
    return write_view


@pytest.fixture
def odometry_tree(tmp_path: Path) -> Path:
    """A data root with a KITTI odometry sequence 00 of 30 frames."""
    sequence = tmp_path / "dataset" / "sequences" / "00"
    for frame in range(FRAMES):
        write_image(sequence / "image_0" / f"{frame:06d}.png", frame)
        write_image(sequence / "image_2" / f"{frame:06d}.png", frame, channels=3)
    (sequence / "calib.txt").write_text(f"P0: {projection(71.8, 60.7)}\nP2: {projection(72.5, 61.5)}\n")
    (sequence / "times.txt").write_text("".join(f"{frame / 10:e}\n" for frame in range(FRAMES)))
    (tmp_path / "dataset" / "poses").mkdir()
    poses = (f"1 0 0 {x:e} 0 1 0 0 0 0 1 {z:e}\n" for x, z in zip(EAST, NORTH, strict=True))
    (tmp_path / "dataset" / "poses" / "00.txt").write_text("".join(poses))
    return tmp_path


@pytest.fixture
def raw_tree(tmp_path: Path) -> Path:
    """A data root with the first 30 frames of the raw drive of sequence 00."""
    day = tmp_path / "2011_10_03"
    drive = day / "2011_10_03_drive_0027_sync"
    (drive / "oxts" / "data").mkdir(parents=True)
    for frame in range(FRAMES):
        write_image(drive / "image_00" / "data" / f"{frame:010d}.png", frame)
        latitude = ORIGIN[0] + NORTH[frame] / METRES_PER_DEGREE[0]
        longitude = ORIGIN[1] + EAST[frame] / METRES_PER_DEGREE[1]
        fix = [latitude, longitude, 112.8, 0.03, 0.01, np.pi / 2, *[0.0] * 24]
        (drive / "oxts" / "data" / f"{frame:010d}.txt").write_text(" ".join(f"{v:.14f}" for v in fix) + "\n")
    stamps = (f"2011-10-03 12:55:{frame // 10:02d}.{frame % 10}00000256\n" for frame in range(FRAMES))
    (drive / "image_00" / "timestamps.txt").write_text("".join(stamps))
    (day / "calib_cam_to_cam.txt").write_text(f"calib_time: 09-Jan-2012\nP_rect_00: {projection(71.8, 60.7)}\n")
    return tmp_path


@pytest.fixture
def own_drive(tmp_path: Path) -> Callable[..., Path]:
    """Write a drive of a user's own, its CSV given as text; images img/0.png to img/3.png lie beside it."""

    def write(csv: str, name: str = "day1") -> Path:
        for frame in range(4):
            write_image(tmp_path / name / "img" / f"{frame}.png", frame, size=(200, 100))
        path = tmp_path / name / "frames.csv"
        path.write_text(csv, encoding="utf-8")
        return path

    return write
