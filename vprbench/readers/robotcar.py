"""Oxford RobotCar: images named by the microsecond, and the fixes of a GPS and inertial system beside them.

Maddern, Pascoe, Linegar, Newman, "1 Year, 1000 km: The Oxford RobotCar dataset", IJRR 2017. The layout is
`DRIVE/stereo/centre/MICROSECONDS.png`, `DRIVE/stereo.timestamps` and `DRIVE/gps/ins.csv`; images are raw Bayer
mosaics, of which its development kit says the patterns, and are not rectified here. Positions are those of the
inertial unit, not of the camera.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
from jaxtyping import Float64, Int64

from vprbench.availability import Need, need_of
from vprbench.errors import DataError
from vprbench.geodesy import derived_headings, local_positions
from vprbench.readers.bayer import Bayer, is_colour
from vprbench.readers.crop import Crop
from vprbench.readers.fixes import Fixes, read_fixes
from vprbench.readers.images import ImageFiles, content_hash, image_size, optics
from vprbench.readers.number_files import check_increasing, read_text
from vprbench.recruiting import Odometer
from vprbench.route import Camera, Traverse

__all__ = ["FixSource", "RobotCarCamera", "RobotCarDrive", "Stretch", "Thinning"]

RobotCarCamera = Literal["stereo/left", "stereo/centre", "stereo/right", "mono_left", "mono_right", "mono_rear"]
FixSource = Literal["ins", "gps"]

_PATTERNS: Mapping[str, Bayer] = {"stereo": "gbrg", "mono": "rggb"}
_COLUMNS = (
    *("timestamp", "ins_status", "num_satellites", "latitude", "longitude", "altitude"),
    *("latitude_sigma", "longitude_sigma", "altitude_sigma", "northing", "easting", "down", "utm_zone"),
    *("velocity_north", "velocity_east", "velocity_down", "roll", "pitch", "yaw"),
)


@dataclass(frozen=True)
class Stretch:
    """A drive, or what lies between two timestamps of it.

    Attributes:
        drive: its name, "2014-12-09-13-21-02".
        first: microseconds, of the first image at the earliest; None: from its beginning.
        last: microseconds, of the last image at the latest; None: to its end.
    """

    drive: str
    first: int | None = None
    last: int | None = None

    @classmethod
    def parse(cls, text: str) -> Stretch:
        """Read "drive" or "drive:first-last"; ValueError where it is neither."""
        match = re.fullmatch(r"([\w.-]+?)(?::(\d{1,18})-(\d{1,18}))?", text, re.ASCII)
        if match is None:
            raise ValueError(f'{text!r} is neither "drive" nor "drive:first-last", its timestamps in microseconds')
        if match[2] is None:
            return cls(match[1])
        if int(match[2]) >= int(match[3]):
            raise ValueError(f"{text!r} ends before it begins")
        return cls(match[1], int(match[2]), int(match[3]))


@dataclass(frozen=True)
class Thinning:
    """Which of the camera's frames, 16 or 11 a second, are kept.

    Attributes:
        every: each so manieth.
        spacing: and of these each that is at least so much road after the last one kept, metres.
    """

    every: int = 1
    spacing: float = 0.0


@dataclass(frozen=True)
class RobotCarDrive:
    """One drive on disk, or a stretch of it.

    Attributes:
        root: the folder that holds the drives.
        stretch: its name, and which of it.
        camera: whose images are taken.
        fixes: the inertial system's, or the GPS receiver's alone, which knows no heading.
        thinning: which frames are kept.
        raw: whether the images are Bayer mosaics, as published.
        crop: the band of the images that becomes the frame; None for all of them.
    """

    root: Path
    stretch: Stretch
    camera: RobotCarCamera = "stereo/centre"
    fixes: FixSource = "ins"
    thinning: Thinning = Thinning()
    raw: bool = True
    crop: Crop | None = None

    @property
    def folder(self) -> Path:
        """The drive's own folder."""
        return self.root / self.stretch.drive

    @property
    def timestamps(self) -> Path:
        """The file that lists the camera's images."""
        return self.folder / f"{self.camera.split('/')[0]}.timestamps"

    @property
    def table(self) -> Path:
        """The file of the fixes."""
        return self.folder / "gps" / f"{self.fixes}.csv"

    @property
    def images(self) -> tuple[Path, ...]:
        """The image of each frame."""
        return tuple(self.folder / self.camera / f"{stamp}.png" for stamp in self._stamps)

    def need(self) -> Need:
        """The frames, numbered as they are listed; the list, and the fixes."""
        remedy = (
            f"Unpack {self.camera} and gps of the drive {self.stretch.drive} of Oxford RobotCar "
            f"(https://robotcar-dataset.robots.ox.ac.uk) in {self.root}, or say where they are with --data or "
            "VPRBENCH_DATA."
        )
        source, others = f"RobotCar drive {self.stretch.drive}", (self.timestamps, self.table)
        absent = tuple(path for path in others if not path.is_file())
        if absent:
            return Need(source, self.folder, (), (), absent, remedy)
        numbers = np.searchsorted(self._listed, self._stamps)
        files = {int(number): (path,) for number, path in zip(numbers, self.images, strict=True)}
        return need_of(source, self.folder / self.camera, files, others, remedy)

    @cached_property
    def geodetic(self) -> Float64[np.ndarray, "n 2"]:
        """Latitude and longitude of each frame, degrees."""
        return self._fixes.geodetic_at(self._stamps)

    def traverse(self, camera: Callable[[int], Camera], origin: Float64[np.ndarray, "2"]) -> Traverse:
        """The drive, in the local plane about `origin` (latitude, longitude).

        Args:
            camera: of the reduced frames, given the width of the images, pixels.
            origin: of the plane.
        """
        paths, stamps, yaw = self.images, self._stamps, self._fixes.yaw_at(self._stamps)
        if self.raw and is_colour(paths[0]):
            raise DataError(f"{paths[0]}: in colour, so no raw mosaic any more; set raw = false")
        positions = local_positions(self.geodetic, origin)
        headings = (
            derived_headings(positions, self._name, 'take a longer one, or fixes = "ins"') if yaw is None else yaw
        )
        size = image_size(paths[0])
        seen_by = camera(size[0])
        motion = (self.geodetic, headings, stamps.astype(np.float64), np.array([float(self.raw)]))
        return Traverse(
            name=self._name,
            frames=ImageFiles(paths, size, crop=self.crop, bayer=self._pattern),
            positions=positions,
            headings=headings,
            times=(stamps - stamps[0]) / 1e6,
            camera=seen_by,
            indices=stamps,
            checksum=content_hash(paths, *motion, *optics(seen_by, self.crop)),
            geodetic=self.geodetic,
            heading_source="derived" if yaw is None else "measured",
        )

    @property
    def _pattern(self) -> Bayer | None:
        return _PATTERNS[self.camera.split("/")[0].split("_")[0]] if self.raw else None

    @property
    def _name(self) -> str:
        left_out = len(self._asked) - int(self._fixes.cover(self._asked).sum())
        said = f"; {left_out} images left out, not between two good fixes" if left_out else ""
        return f"RobotCar {self.stretch.drive}, {self.camera}, {len(self._stamps)} frames{said}"

    @cached_property
    def _fixes(self) -> Fixes:
        return read_fixes(self.table, _COLUMNS)

    @cached_property
    def _listed(self) -> Int64[np.ndarray, " all"]:
        """The timestamps of the camera's images, microseconds."""
        lines = read_text(self.timestamps).splitlines()
        stamps = [_stamp(line, f"{self.timestamps}, line {number}") for number, line in enumerate(lines, 1)]
        check_increasing(np.array(stamps) / 1e6, lambda row: f"{self.timestamps}, line {row + 1}")
        return np.array(stamps, np.int64)

    @cached_property
    def _asked(self) -> Int64[np.ndarray, " asked"]:
        """Each so manieth timestamp of the run."""
        first, last = self.stretch.first, self.stretch.last
        start = 0 if first is None else int(np.searchsorted(self._listed, first))
        end = None if last is None else int(np.searchsorted(self._listed, last, side="right"))
        return self._listed[start:end][:: self.thinning.every]

    @cached_property
    def _stamps(self) -> Int64[np.ndarray, " n"]:
        """Those of them that the fixes cover, thinned by the road between them."""
        asked = self._asked[self._fixes.cover(self._asked)]
        if len(asked):
            geodetic = self._fixes.geodetic_at(asked)
            odometer = Odometer(self.thinning.spacing)
            asked = asked[[odometer.due(position) for position in local_positions(geodetic, geodetic[0])]]
        if len(asked) < 2:
            whole = f"of {len(self._asked)} images asked for, {len(asked)} lie between two good fixes far enough apart"
            raise DataError(f"{self.timestamps}: {whole}, and a drive has at least two")
        return asked


def _stamp(line: str, where: str) -> int:
    """The first word of a line, microseconds; the second is the chunk of the download."""
    word = line.split()[0] if line.split() else ""
    if not word.isascii() or not word.isdigit() or len(word) > 18:
        raise DataError(f"{where}: {line!r} does not begin with whole microseconds")
    return int(word)
