"""The catalogue entry for anyone's own drives."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from vprbench.availability import Need
from vprbench.entries.images import ImagesEntry, OwnPath, refuse_shared
from vprbench.readers.folder import FolderDrive
from vprbench.route import Route

__all__ = ["FolderEntry"]


class FolderEntry(ImagesEntry):
    """A route of a user's own, each drive a CSV beside its images; paths are relative to the catalogue file.

    Attributes:
        learn: the CSV of the learn drive, or the folder that holds its `frames.csv`.
        test: that of the test drive.
        training: those of drives off the route.
    """

    reader: Literal["folder"]
    learn: OwnPath
    test: OwnPath
    training: tuple[OwnPath, ...] = ()

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        return tuple(drive.need() for drive in self._drives())

    def read(self, name: str, root: Path) -> Route:
        """The route; with latitude and longitude, in the local plane about the learn drive's first fix."""
        drives = self._drives()
        refuse_shared((drive.path, drive.images) for drive in drives)
        origin = None if drives[0].geodetic is None else drives[0].geodetic[0]
        learn, test, *training = (drive.traverse(self.camera.reduced, origin) for drive in drives)
        return Route(name, learn, test, tuple(training), self.environment, self.split)

    def _drives(self) -> tuple[FolderDrive, ...]:
        paths = (self.learn, self.test, *self.training)
        return tuple(FolderDrive(path if path.suffix == ".csv" else path / "frames.csv", self.crop) for path in paths)
