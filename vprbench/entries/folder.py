"""The catalogue entry for anyone's own drives."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Literal

from vprbench.availability import Need
from vprbench.entries.images import ImagesEntry, OwnPath, refuse_shared
from vprbench.errors import ConfigError
from vprbench.readers.crop import Crop
from vprbench.readers.folder import FolderDrive
from vprbench.route import Route

__all__ = ["FolderEntry", "folder_drive"]


class FolderEntry(ImagesEntry):
    """A route of a user's own, each drive a CSV beside its images; paths are relative to the catalogue file.

    Attributes:
        learn: the CSV of the learn drive, or the folder that holds its `frames.csv`; ":first-last" after it for a part.
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
        refuse_shared((drive.name, drive.images) for drive in drives)
        origin = None if drives[0].geodetic is None else drives[0].geodetic[0]
        learn, test, *training = (drive.traverse(self.camera.reduced, origin) for drive in drives)
        return Route(name, learn, test, tuple(training), self.environment, self.split)

    def _drives(self) -> tuple[FolderDrive, ...]:
        return tuple(folder_drive(path, self.crop) for path in (self.learn, self.test, *self.training))


def folder_drive(path: Path, crop: Crop | None = None) -> FolderDrive:
    """The drive that a path names: a CSV or the folder that holds its `frames.csv`, and perhaps which frames."""
    # A folder may have a name like that, too.
    part = None if path.exists() else re.fullmatch(r"(.+):(\d{1,6})-(\d{1,6})", str(path))
    whole, frames = (Path(part[1]), (int(part[2]), int(part[3]))) if part else (path, None)
    if frames and frames[0] >= frames[1]:
        raise ConfigError(f"{path} ends before it has two frames")
    return FolderDrive(whole if whole.suffix == ".csv" else whole / "frames.csv", frames, crop)
