"""KITTI raw recordings with their GPS and inertial fixes (OXTS), synchronised and rectified.

The layout is `DATE/DATE_drive_NNNN_sync/image_00/data/NNNNNNNNNN.png`, `.../oxts/data/NNNNNNNNNN.txt` and
`DATE/calib_cam_to_cam.txt`. Geiger, Lenz, Stiller, Urtasun, "Vision meets robotics: the KITTI dataset", IJRR 2013.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Literal

import numpy as np
from jaxtyping import Float64

from vprbench.availability import Need, need_of
from vprbench.errors import DataError
from vprbench.frame_ranges import FrameRun
from vprbench.geodesy import check_geodetic, compass_heading, local_positions
from vprbench.readers.kitti import Motion, filmed, read_projection
from vprbench.readers.number_files import check_increasing, read_numbers, read_text
from vprbench.route import Traverse

__all__ = ["RawCamera", "RawDrive", "raw_run"]

RawCamera = Literal["image_00", "image_01", "image_02", "image_03"]

# Latitude, longitude, altitude, roll, pitch, yaw, and 24 more.
_OXTS_COLUMNS, _YAW = 30, 5

_STAMP = re.compile(r"[12]\d{3}-\d\d-\d\d \d\d:\d\d:\d\d(\.\d{1,9})?", re.ASCII)


@dataclass(frozen=True)
class RawDrive:
    """One raw drive on disk.

    Attributes:
        root: the folder that holds the dates.
        name: for example "2011_10_03_drive_0027".
        camera: "image_00", "image_01" (grey), "image_02" or "image_03" (colour, converted to grey).
    """

    root: Path
    name: str
    camera: RawCamera = "image_00"

    @property
    def folder(self) -> Path:
        """The drive's own folder."""
        return self._date / f"{self.name}_sync"

    @property
    def calibration(self) -> Path:
        """The file of the day's camera calibration."""
        return self._date / "calib_cam_to_cam.txt"

    @property
    def timestamps(self) -> Path:
        """The file of the times at which the camera's frames were taken."""
        return self.folder / self.camera / "timestamps.txt"

    def need(self, frames: Iterable[int]) -> Need:
        """These frames with their fixes, and the day's calibration."""
        remedy = (
            f"Or unzip the [synced+rectified data] of {self.name} and the [calibration] of its day, KITTI raw data "
            f"(https://www.cvlibs.net/datasets/kitti/raw_data.php), in {self.root}, or say where they are with "
            "--data or VPRBENCH_DATA."
        )
        files = {i: (self._image(i), self._fix(i)) for i in frames}
        others = (self.calibration, self.timestamps)
        return need_of(f"KITTI raw drive {self.name}", self.folder, files, others, remedy, public=True)

    def fixes(self, frames: Iterable[int]) -> Float64[np.ndarray, "n 3"]:
        """Latitude and longitude, degrees, and yaw, radians, at each frame."""
        rows = [self._read_fix(frame) for frame in frames]
        return np.concatenate(rows)[:, [0, 1, _YAW]]

    def whole(self) -> FrameRun:
        """All frames that have a fix; DataError where there are none."""
        numbers = sorted(int(path.stem) for path in (self.folder / "oxts" / "data").glob("[0-9]*.txt"))
        if len(numbers) < 2:
            missing = "no fixes of a drive; its [synced+rectified data] belong there"
            raise DataError(f"{self.folder / 'oxts' / 'data'}: {missing}")
        return FrameRun(self.name, numbers[0], numbers[-1])

    def motion(self, run: FrameRun) -> Motion:
        """Where the vehicle was along a run of frames, in the local plane about its first fix."""
        fixes = self.fixes(run.frames)
        return _motion(fixes, self._times(run), fixes[0, :2])

    def traverse(self, run: FrameRun, origin: Float64[np.ndarray, "2"]) -> Traverse:
        """The drive along a run of frames, in the local plane about `origin` (latitude, longitude)."""
        fixes = self.fixes(run.frames)
        geodetic, times = fixes[:, :2], self._times(run)
        motion = _motion(fixes, times, origin)
        projection = read_projection(self.calibration, f"P_rect_{self.camera[-2:]}")
        paths = tuple(self._image(i) for i in run.frames)
        colour = self.camera in ("image_02", "image_03")
        drive = filmed(f"KITTI {self.name}", run, paths, projection, motion, (fixes, times), colour=colour)
        return replace(drive, geodetic=geodetic)

    def _times(self, run: FrameRun) -> Float64[np.ndarray, " n"]:
        """Seconds since the drive's first frame."""
        lines = read_text(self.timestamps).splitlines()
        if len(lines) <= run.last:
            raise DataError(f"{self.timestamps}: {len(lines)} lines, too few for frame {run.last}")
        start = _instant(lines[0], self.timestamps, 1)
        instants = [_instant(lines[i], self.timestamps, i + 1) for i in run.frames]
        times = (np.array(instants) - start) / np.timedelta64(1, "s")
        check_increasing(times, lambda row: f"{self.timestamps}, line {run.first + row + 1}")
        return times

    def _read_fix(self, frame: int) -> Float64[np.ndarray, "1 30"]:
        path = self._fix(frame)
        row = read_numbers(path, _OXTS_COLUMNS)
        if len(row) != 1:
            raise DataError(f"{path}: {len(row)} lines where one is due")
        check_geodetic(row[:, :2], lambda _: str(path))
        if abs(row[0, _YAW]) > 2 * np.pi:
            raise DataError(f"{path}: yaw {row[0, _YAW]:g} is not within a turn, 6.28 rad")
        return row

    @property
    def _date(self) -> Path:
        return self.root / self.name[: len("2011_10_03")]

    def _image(self, frame: int) -> Path:
        return self.folder / self.camera / "data" / f"{frame:010d}.png"

    def _fix(self, frame: int) -> Path:
        return self.folder / "oxts" / "data" / f"{frame:010d}.txt"


def _motion(
    fixes: Float64[np.ndarray, "n 3"], times: Float64[np.ndarray, " n"], origin: Float64[np.ndarray, "2"]
) -> Motion:
    return Motion(local_positions(fixes[:, :2], origin), compass_heading(fixes[:, 2]), times)


def raw_run(run: FrameRun) -> FrameRun:
    """The frames of a raw drive that a run of an odometry sequence is; other runs are left as they are.

    ValueError where the run goes on after the sequence's end.
    """
    whole = _sequences().get(run.sequence)
    if whole is None:
        return run
    first, last = whole.first + run.first, whole.first + run.last
    if last > whole.last:
        raise ValueError(f'"{run}" goes on after the last frame of the sequence, {whole.last - whole.first}')
    return FrameRun(whole.sequence, first, last)


@cache
def _sequences() -> Mapping[str, FrameRun]:
    text = (resources.files("vprbench") / "data" / "kitti_raw.toml").read_text("utf-8")
    return {sequence: FrameRun.parse(run) for sequence, run in tomllib.loads(text).items()}


def _instant(line: str, path: Path, number: int) -> np.datetime64:
    # NumPy would take "now" and "5" (a year) too.
    if _STAMP.fullmatch(line.strip()):
        with suppress(ValueError):
            return np.datetime64(line.strip().replace(" ", "T"), "ns")
    raise DataError(f"{path}, line {number}: {line!r} is not a time, for example 2011-10-03 12:55:34.931552000")
