"""The KITTI odometry benchmark: `dataset/sequences/SS/image_0/NNNNNN.png` and `dataset/poses/SS.txt`.

Geiger, Lenz, Urtasun, "Are we ready for autonomous driving? The KITTI vision benchmark suite", CVPR 2012.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
from jaxtyping import Float64

from vprbench.availability import Need, need_of
from vprbench.errors import DataError
from vprbench.frame_ranges import FrameRun
from vprbench.readers.images import ImageFiles, content_hash, image_size, scaled_camera
from vprbench.readers.motion import Motion
from vprbench.readers.number_files import check_increasing, read_numbers, read_text
from vprbench.readers.speed import check_speed
from vprbench.route import Traverse

__all__ = ["Motion", "OdometryCamera", "OdometrySequence", "filmed", "read_motion", "read_projection"]

# Left grey and left colour: the benchmark's poses are those of camera 0.
OdometryCamera = Literal["image_0", "image_2"]

# How far a rotation times its transpose may be from unity; KITTI's are nearer than 1e-5. Our choice.
_SKEW = 0.01

# Frames a second, nominal.
_RATE = 10.0

_REMEDY = (
    "Or unzip the KITTI odometry benchmark's {images}, calibration files and ground truth poses "
    "(https://www.cvlibs.net/datasets/kitti/eval_odometry.php) there, or say where they are with --data or "
    "VPRBENCH_DATA."
)
_IMAGES = {"image_0": "data set (grayscale, 22 GB)", "image_2": "data set (color, 65 GB)"}


@dataclass(frozen=True)
class OdometrySequence:
    """One sequence of the benchmark on disk.

    Attributes:
        root: the folder that holds `dataset/`, or that folder itself.
        name: "00" to "10" (the others have no poses).
        camera: "image_0" (grey) or "image_2" (colour, converted to grey).
    """

    root: Path
    name: str
    camera: OdometryCamera = "image_0"

    @property
    def folder(self) -> Path:
        """The sequence's own folder."""
        return _dataset(self.root) / "sequences" / self.name

    @property
    def poses(self) -> Path:
        """The file of the sequence's ground truth poses."""
        return _dataset(self.root) / "poses" / f"{self.name}.txt"

    def need(self, frames: Iterable[int]) -> Need:
        """These frames and the sequence's pose, time and calibration files."""
        files = {i: (self._file(i),) for i in frames}
        others = [self.poses, self.folder / "times.txt", self.folder / "calib.txt"]
        remedy = _REMEDY.format(images=_IMAGES[self.camera])
        return need_of(
            f"KITTI odometry sequence {self.name}", self.folder / self.camera, files, others, remedy, public=True
        )

    @cached_property
    def motion(self) -> Motion:
        """The pose and time of every frame of the sequence."""
        return read_motion(self.poses, self.folder / "times.txt")

    def traverse(self, run: FrameRun) -> Traverse:
        """The drive along a run of frames; DataError where the sequence ends before the run."""
        if run.last >= len(self.motion.times):
            raise DataError(f"{self.poses}: {len(self.motion.times)} poses, too few for frame {run.last}")
        drive = slice(run.first, run.last + 1)
        motion = Motion(*(values[drive] for values in self.motion))
        paths = tuple(self._file(i) for i in run.frames)
        projection = read_projection(self.folder / "calib.txt", f"P{self.camera[-1]}")
        return filmed(f"KITTI {self.name}", run, paths, projection, motion, motion, colour=self.camera == "image_2")

    def _file(self, frame: int) -> Path:
        return self.folder / self.camera / f"{frame:06d}.png"


def filmed(
    name: str,
    run: FrameRun,
    paths: tuple[Path, ...],
    projection: Float64[np.ndarray, "3 4"],
    motion: Motion,
    measured: tuple[Float64[np.ndarray, "..."], ...],
    *,
    colour: bool,
) -> Traverse:
    """The drive that a KITTI camera filmed.

    Args:
        name: of the recording.
        run: the frames' numbers in it.
        paths: their image files.
        projection: of the camera, pixels of those images.
        motion: where the vehicle was at each of them.
        measured: the arrays that the motion was computed from, which the checksum is of.
        colour: whether the camera is a colour camera.
    """
    check_speed(motion.positions, motion.times, lambda row: f"{name}, frame {run.first + row}")
    size = image_size(paths[0])
    return Traverse(
        name=f"{name}, frames {run.first}-{run.last}",
        frames=ImageFiles(paths, size, colour=colour),
        positions=motion.positions,
        headings=motion.headings,
        times=motion.times,
        camera=scaled_camera(projection[0, 0], projection[0, 2], size[0], str(paths[0])),
        indices=np.arange(run.first, run.last + 1),
        checksum=content_hash(paths, *measured, projection),
    )


def read_motion(poses: Path, times: Path | None) -> Motion:
    """A sequence's motion on the ground plane (x, z) of camera 0, from its pose and time files.

    Positions are (P[0,3], P[2,3]) and headings atan2(P[0,2], P[2,2]) of each 3x4 pose P: with x as east
    and z as north, clockwise from north. Without a time file, frames are taken to come ten a second.
    """
    matrices = read_numbers(poses, 12).reshape(-1, 3, 4)
    _check_rotations(matrices[:, :, :3], poses)
    headings = np.arctan2(matrices[:, 0, 2], matrices[:, 2, 2])
    if times is None:
        return Motion(matrices[:, [0, 2], 3], headings, np.arange(len(matrices)) / _RATE)
    seconds = read_numbers(times, 1)[:, 0]
    if len(seconds) != len(matrices):
        raise DataError(f"{times}: {len(seconds)} times for the {len(matrices)} poses in {poses}")
    check_increasing(seconds, lambda row: f"{times}, line {row + 1}")
    return Motion(matrices[:, [0, 2], 3], headings, seconds)


def _check_rotations(rotations: Float64[np.ndarray, "n 3 3"], poses: Path) -> None:
    """Refuse poses that turn nothing as a rotation does: their numbers are shifted or damaged."""
    stretched = np.abs(rotations @ rotations.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2)) > _SKEW
    bad = np.flatnonzero(stretched | (np.linalg.det(rotations) < 0))
    if bad.size:
        raise DataError(f"{poses}, line {bad[0] + 1}: not a pose, since its 3 x 3 part is no rotation")


def read_projection(path: Path, key: str) -> Float64[np.ndarray, "3 4"]:
    """The projection matrix that a KITTI calibration file gives under `key`, pixels."""
    for line, text in enumerate(read_text(path).splitlines(), 1):
        name, _, values = text.partition(":")
        if name.strip() == key:
            return _projection(values.split(), f"{path}, line {line}")
    raise DataError(f"{path}: no line {key!r}")


def _projection(words: list[str], where: str) -> Float64[np.ndarray, "3 4"]:
    try:
        matrix = np.array(words, np.float64).reshape(3, 4)
    except ValueError as error:
        raise DataError(f"{where}: not the 12 numbers of a projection matrix") from error
    if not np.isfinite(matrix).all() or matrix[0, 0] <= 0:
        raise DataError(f"{where}: the focal length must be finite and positive")
    return matrix


def _dataset(root: Path) -> Path:
    return root if (root / "sequences").is_dir() else root / "dataset"
