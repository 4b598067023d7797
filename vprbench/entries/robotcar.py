"""The catalogue entry for Oxford RobotCar."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from vprbench.availability import Need
from vprbench.entries.images import ImagesEntry, refuse_shared
from vprbench.readers.robotcar import FixSource, RobotCarCamera, RobotCarDrive, Stretch, Thinning
from vprbench.route import Route

__all__ = ["RobotCarEntry"]


def _stretch(value: object) -> object:
    return Stretch.parse(value) if isinstance(value, str) else value


_Stretch = Annotated[Stretch, BeforeValidator(_stretch)]


class RobotCarEntry(ImagesEntry):
    """A route in Oxford RobotCar, placed by its fixes.

    Attributes:
        learn: the learn drive, "2014-12-09-13-21-02", or what lies between two timestamps of it, microseconds.
        test: the test drive.
        training: drives off the route.
        view: the camera whose images are taken.
        fixes: "ins", or "gps", which knows no heading.
        every: each so manieth image is taken.
        spacing: and of these each that is at least so much road after the last one taken, metres.
        raw: whether the images are Bayer mosaics, as published.
    """

    reader: Literal["robotcar"]
    learn: _Stretch
    test: _Stretch
    training: tuple[_Stretch, ...] = ()
    view: RobotCarCamera = "stereo/centre"
    fixes: FixSource = "ins"
    every: Annotated[int, Field(ge=1)] = 1
    spacing: Annotated[float, Field(ge=0)] = 0.0
    raw: bool = True

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        return tuple(drive.need() for drive in self._drives(root))

    def read(self, name: str, root: Path) -> Route:
        """The route, in the local plane about the learn drive's first frame."""
        drives = self._drives(root)
        refuse_shared((drive.folder, drive.images) for drive in drives)
        origin = drives[0].geodetic[0]
        learn, test, *training = (drive.traverse(self.camera.reduced, origin) for drive in drives)
        return Route(name, learn, test, tuple(training), self.environment, self.split)

    def _drives(self, root: Path) -> tuple[RobotCarDrive, ...]:
        thinning = Thinning(self.every, self.spacing)
        return tuple(
            RobotCarDrive(root, stretch, self.view, self.fixes, thinning, self.raw, self.crop)
            for stretch in (self.learn, self.test, *self.training)
        )
