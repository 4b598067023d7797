"""Catalogue entries for KITTI: the odometry benchmark and the raw recordings."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, model_validator

from vprbench.availability import Need
from vprbench.entries.base import Run, RunsEntry
from vprbench.readers.kitti import OdometryCamera, OdometrySequence
from vprbench.readers.kitti_raw import RawCamera, RawDrive, raw_run
from vprbench.route import Route

__all__ = ["KittiOdometryEntry", "KittiRawEntry"]

_RawRun = Annotated[Run, AfterValidator(raw_run)]


class KittiOdometryEntry(RunsEntry):
    """A route in the KITTI odometry benchmark.

    Attributes:
        learn: the frames of the learn drive.
        test: those of the test drive, in the same sequence.
        training: drives off the route.
        camera: the folder of images to use.
    """

    reader: Literal["kitti-odometry"]
    camera: OdometryCamera = "image_0"

    @model_validator(mode="after")
    def _one_sequence(self) -> KittiOdometryEntry:
        if self.learn.sequence != self.test.sequence:
            raise ValueError("learn and test lie in two sequences, whose poses have no common origin")
        return self

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        return tuple(OdometrySequence(root, s, self.camera).need(f) for s, f in self.frames().items())

    def read(self, name: str, root: Path) -> Route:
        """The route, on the ground plane of its sequence."""
        sequences = {s: OdometrySequence(root, s, self.camera) for s in self.frames()}
        learn, test, *training = (sequences[run.sequence].traverse(run) for run in self.runs)
        return Route(name, learn, test, tuple(training), self.environment, self.split)


class KittiRawEntry(RunsEntry):
    """A route in KITTI's raw recordings, placed by their GPS and inertial fixes.

    Attributes:
        learn: the frames of the learn drive, of a raw drive or of an odometry sequence ("00:113-205").
        test: those of the test drive.
        training: drives off the route.
        camera: the folder of images to use.
    """

    reader: Literal["kitti-raw"]
    learn: _RawRun
    test: _RawRun
    training: tuple[_RawRun, ...] = ()
    camera: RawCamera = "image_00"

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        return tuple(RawDrive(root, drive, self.camera).need(f) for drive, f in self.frames().items())

    def read(self, name: str, root: Path) -> Route:
        """The route, in the local plane about the learn drive's first fix."""
        drives = {drive: RawDrive(root, drive, self.camera) for drive in self.frames()}
        origin = drives[self.learn.sequence].fixes([self.learn.first])[0, :2]
        learn, test, *training = (drives[run.sequence].traverse(run, origin) for run in self.runs)
        return Route(name, learn, test, tuple(training), self.environment, self.split)
