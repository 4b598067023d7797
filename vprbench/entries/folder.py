"""The catalogue entry for anyone's own drives."""

from __future__ import annotations

import math
import re
from itertools import combinations
from os.path import realpath  # Path.resolve raises where links run in a circle
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationInfo, model_validator

from vprbench.availability import Need
from vprbench.data_root import expanded
from vprbench.entries.base import Entry
from vprbench.errors import ConfigError, DataError
from vprbench.readers.folder import FolderDrive
from vprbench.readers.images import scaled_camera
from vprbench.route import Camera, Route

__all__ = ["FolderEntry", "OwnCamera", "folder_drive"]


def _beside_the_file(path: Path, info: ValidationInfo) -> Path:
    return Path(info.context["folder"], expanded(path)) if info.context else path


_OwnPath = Annotated[Path, AfterValidator(_beside_the_file)]


class OwnCamera(BaseModel):
    """A user's camera: focal length and principal column, or the horizontal field of view.

    Attributes:
        fx: pixels of the original image.
        cx: pixels of the original image.
        field_of_view_deg: degrees, with the principal column in the middle.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    fx: Annotated[float, Field(gt=0)] | None = None
    cx: Annotated[float, Field(gt=0)] | None = None
    field_of_view_deg: Annotated[float, Field(gt=0, lt=180)] | None = None

    @model_validator(mode="after")
    def _one_way(self) -> OwnCamera:
        given = tuple(value is not None for value in (self.fx, self.cx, self.field_of_view_deg))
        if given not in {(True, True, False), (False, False, True)}:
            raise ValueError("a camera has either fx and cx or field_of_view_deg")
        return self

    def reduced(self, width: int) -> Camera:
        """The camera of the reduced frames, given the width of the original image, pixels."""
        if self.fx is not None and self.cx is not None:
            return scaled_camera(self.fx, self.cx, width, "the images")
        assert self.field_of_view_deg is not None
        return scaled_camera(width / 2 / math.tan(math.radians(self.field_of_view_deg) / 2), width / 2, width, "")


class FolderEntry(Entry):
    """A route of a user's own, each drive a CSV beside its images; paths are relative to the catalogue file.

    Attributes:
        learn: the CSV of the learn drive, or the folder that holds its `frames.csv`; ":first-last" after it for a part.
        test: that of the test drive.
        training: those of drives off the route.
        camera: of all drives.
    """

    reader: Literal["folder"]
    learn: _OwnPath
    test: _OwnPath
    training: tuple[_OwnPath, ...] = ()
    camera: OwnCamera

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        return tuple(drive.need() for drive in self._drives())

    def read(self, name: str, root: Path) -> Route:
        """The route; with latitude and longitude, in the local plane about the learn drive's first fix."""
        drives = self._drives()
        for a, b in combinations(drives, 2):
            shared = sorted({realpath(image) for image in a.images} & {realpath(image) for image in b.images})
            if shared:
                more = f" and {len(shared) - 1} more" if len(shared) > 1 else ""
                raise DataError(f"{a.name} and {b.name} share the image {shared[0]}{more}; leave them out of one")
        origin = None if drives[0].geodetic is None else drives[0].geodetic[0]
        learn, test, *training = (drive.traverse(self.camera.reduced, origin) for drive in drives)
        return Route(name, learn, test, tuple(training), self.environment, self.split)

    def _drives(self) -> tuple[FolderDrive, ...]:
        return tuple(folder_drive(path) for path in (self.learn, self.test, *self.training))


def folder_drive(path: Path) -> FolderDrive:
    """The drive that a path names: a CSV or the folder that holds its `frames.csv`, and perhaps which frames."""
    # A folder may have a name like that, too.
    part = None if path.exists() else re.fullmatch(r"(.+):(\d{1,6})-(\d{1,6})", str(path))
    whole, frames = (Path(part[1]), (int(part[2]), int(part[3]))) if part else (path, None)
    if frames and frames[0] >= frames[1]:
        raise ConfigError(f"{path} ends before it has two frames")
    return FolderDrive(whole if whole.suffix == ".csv" else whole / "frames.csv", frames)
