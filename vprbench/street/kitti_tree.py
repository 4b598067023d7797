"""Drives written to disk in KITTI's own layouts, for whoever tests a reader without the data set."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float64

from vprbench.errors import ConfigError, DataError
from vprbench.route import Camera, Traverse
from vprbench.types import FRAME_WIDTH

__all__ = ["draw_kitti", "draw_kitti_raw"]

# Width and height of KITTI's frames, sequence 00.
_SIZE = (1241, 376)
_PERIOD_MS = 100

Numbered = Mapping[range, Traverse]


def draw_kitti(root: Path, sequence: str, drives: Numbered, size: tuple[int, int] = _SIZE) -> Path:
    """Write drives as one sequence of the KITTI odometry benchmark; the sequence's folder.

    Only the numbered frames get a picture; poses and times run from 0 to the last of them, the poses
    between two drives on a straight line. ConfigError where the numbers do not fit the drives.

    Args:
        root: the data root, in which `dataset/` is made.
        sequence: its number, for example "00".
        drives: the frame numbers of each drive; its frame i becomes the i-th of them.
        size: width and height of the pictures.
    """
    _check(drives)
    folder, poses = root / "dataset" / "sequences" / sequence, root / "dataset" / "poses"
    poses.mkdir(parents=True, exist_ok=True)
    for frames, traverse in drives.items():
        for index, number in enumerate(frames):
            _write_picture(folder / "image_0" / f"{number:06d}.png", traverse, index, size)
    matrices = _poses(drives)
    np.savetxt(poses / f"{sequence}.txt", matrices, fmt="%.9e")
    np.savetxt(folder / "times.txt", np.arange(len(matrices)) * _PERIOD_MS / 1000, fmt="%.6e")
    projection = _projection(next(iter(drives.values())).camera, size)
    (folder / "calib.txt").write_text("".join(f"P{k}: {projection}\n" for k in range(4)))
    return folder


def draw_kitti_raw(root: Path, name: str, traverse: Traverse, first: int = 0, size: tuple[int, int] = _SIZE) -> Path:
    """Write a drive as a KITTI raw recording, synchronised and rectified; the recording's folder.

    DataError where the drive knows no latitude and longitude.

    Args:
        root: the data root, in which the folder of the date is made.
        name: the recording's date and number, for example "2011_10_03_drive_0027".
        traverse: the drive.
        first: number of its first frame; those before it have a time, but no picture and no fix.
        size: width and height of the pictures.
    """
    if traverse.geodetic is None:
        raise DataError(f"{traverse.name}: no latitude and longitude, which a raw recording needs")
    date = name[: len("2011_10_03")]
    folder = root / date / f"{name}_sync"
    (folder / "oxts" / "data").mkdir(parents=True, exist_ok=True)
    for index, (place, heading) in enumerate(zip(traverse.geodetic, traverse.headings, strict=True)):
        _write_picture(folder / "image_00" / "data" / f"{first + index:010d}.png", traverse, index, size)
        (folder / "oxts" / "data" / f"{first + index:010d}.txt").write_text(_fix(place, heading))
    for sensor in ("image_00", "oxts"):
        (folder / sensor / "timestamps.txt").write_text(_timestamps(date, first + len(traverse)))
    calibration = f"S_rect_00: {size[0]:e} {size[1]:e}\nP_rect_00: {_projection(traverse.camera, size)}\n"
    (root / date / "calib_cam_to_cam.txt").write_text(calibration)
    return folder


def _check(drives: Numbered) -> None:
    """Refuse no drives, numbers that a drive has no frames for, and numbers that two drives share."""
    if not drives:
        raise ConfigError("draw_kitti: no drives: give at least one")
    taken: set[int] = set()
    for frames, traverse in drives.items():
        if not 0 < len(frames) <= len(traverse) or min(frames) < 0:
            raise ConfigError(f"draw_kitti: {traverse.name}: its {len(traverse)} frames cannot be numbered {frames}")
        if not taken.isdisjoint(frames):
            raise ConfigError(f"draw_kitti: {traverse.name}: another drive has frames of {frames} already")
        taken.update(frames)


def _write_picture(path: Path, traverse: Traverse, index: int, size: tuple[int, int]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = cv2.resize(traverse.frames[index], size, interpolation=cv2.INTER_LINEAR)
    path.write_bytes(cv2.imencode(".png", picture)[1].tobytes())


def _poses(drives: Numbered) -> Float64[np.ndarray, "frames 12"]:
    """The 3x4 pose of every frame from 0 to the last, row by row: east is x, north is z."""
    known = {
        number: (*traverse.positions[i], traverse.headings[i])
        for frames, traverse in drives.items()
        for i, number in enumerate(frames)
    }
    numbers = sorted(known)
    x, z, heading = np.array([known[number] for number in numbers]).T
    every = np.arange(numbers[-1] + 1)
    x, z, heading = (np.interp(every, numbers, values) for values in (x, z, np.unwrap(heading)))
    cos, sin, zero, one = np.cos(heading), np.sin(heading), np.zeros_like(x), np.ones_like(x)
    return np.stack([cos, zero, sin, x, zero, one, zero, zero, -sin, zero, cos, z], axis=1)


def _projection(camera: Camera, size: tuple[int, int]) -> str:
    """The twelve numbers of a projection matrix for pictures of this size."""
    fx, cx = camera.fx * size[0] / FRAME_WIDTH, camera.cx * size[0] / FRAME_WIDTH
    values = (fx, 0, cx, 0, 0, fx, size[1] / 2, 0, 0, 0, 1, 0)
    return " ".join(f"{value:.12e}" for value in values)


def _fix(place: Float64[np.ndarray, "2"], heading: float) -> str:
    """The thirty fields of an OXTS fix: latitude, longitude, altitude, roll, pitch, yaw, then zeros.

    KITTI's yaw runs counter-clockwise from east.
    """
    yaw = (np.pi / 2 - heading + np.pi) % (2 * np.pi) - np.pi
    fields = [*place, 0.0, 0.0, 0.0, yaw, *[0.0] * 24]
    return " ".join(f"{value:.14g}" for value in fields) + "\n"


def _timestamps(date: str, count: int) -> str:
    """The times of all frames, from noon on."""
    noon = np.datetime64(f"{date.replace('_', '-')}T12:00:00", "ns")
    times = noon + np.arange(count) * np.timedelta64(_PERIOD_MS, "ms")
    return "".join(f"{time}\n".replace("T", " ") for time in times)
