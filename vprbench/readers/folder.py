"""Anyone's own drives: images, and a CSV that says where and when each was taken.

The CSV is encoded in UTF-8 and has a header. Its columns, in any order:

- file: the image (PNG or JPEG), relative to the CSV
- time: seconds from 0 up, increasing
- east, north: metres, of one origin for all drives of a route; or latitude, longitude: degrees (WGS 84)
- heading_deg: degrees clockwise from north; without it the heading is the direction of the positions
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from jaxtyping import Float64

from vprbench.availability import Need, need_of
from vprbench.errors import DataError
from vprbench.geodesy import check_geodetic, derived_headings, local_positions, wrap
from vprbench.readers.crop import Crop
from vprbench.readers.csv_table import CsvTable, read_csv
from vprbench.readers.images import ImageFiles, content_hash, image_size, optics
from vprbench.readers.motion import Motion
from vprbench.readers.number_files import check_increasing
from vprbench.readers.speed import check_speed
from vprbench.route import Camera, Traverse

__all__ = ["FolderDrive"]

_LOCAL, _GEODETIC = ("east", "north"), ("latitude", "longitude")


@dataclass(frozen=True)
class FolderDrive:
    """One drive of a user's own, or a part of it.

    Attributes:
        path: the CSV.
        frames: the first and the last frame of the part, counted from 0; None for all.
        crop: the band of its images that becomes the frame; None for all of them.
    """

    path: Path
    frames: tuple[int, int] | None = None
    crop: Crop | None = None

    @property
    def name(self) -> str:
        """The CSV, and which of its frames."""
        return str(self.path) if self.frames is None else "{}, frames {}-{}".format(self.path, *self.frames)

    @cached_property
    def images(self) -> tuple[Path, ...]:
        """The image file of each frame."""
        names = self._table.columns["file"]
        rows: dict[str, int] = {}
        for row, name in enumerate(names):
            if not name:
                raise DataError(f"{self._table.where(row)}: no image; give its file")
            if rows.setdefault(name, row) != row:
                raise DataError(f"{self._table.where(row)}: the image of another line too, {name}")
        return tuple(self.path.parent / name for name in names)

    @cached_property
    def geodetic(self) -> Float64[np.ndarray, "n 2"] | None:
        """Latitude and longitude, degrees; None where the CSV has east and north."""
        if _GEODETIC[0] not in self._table.columns:
            return None
        fixes = self._numbers(_GEODETIC)
        check_geodetic(fixes, self._table.where)
        return fixes

    def need(self) -> Need:
        """The CSV and the images it names, numbered from 0."""
        remedy = f"Put each image where {self.path} says, relative to that file."
        if not self.path.is_file():
            return Need(str(self.path), self.path.parent, (), (), (self.path,), remedy)
        files = {frame: (image,) for frame, image in enumerate(self.images, self._first)}
        return need_of(str(self.path), self.path.parent, files, (), remedy)

    def motion(self, origin: Float64[np.ndarray, "2"] | None) -> Motion:
        """Where the vehicle was at each frame; the origin is that of `traverse`."""
        positions = self._positions(origin)
        times = self._times(positions)
        return Motion(positions, self._headings(positions), times)

    def traverse(self, camera: Callable[[int], Camera], origin: Float64[np.ndarray, "2"] | None) -> Traverse:
        """The drive.

        Args:
            camera: of the reduced frames, given the width of the images, pixels.
            origin: latitude and longitude of the local plane's origin, where the CSV has these.
        """
        positions, headings, times = self.motion(origin)
        size = image_size(self.images[0])
        seen_by = camera(size[0])
        parts = (positions, times, headings, *optics(seen_by, self.crop))
        return Traverse(
            name=self.name if self._has_heading else f"{self.name} (headings from its positions)",
            frames=ImageFiles(self.images, size, crop=self.crop),
            positions=positions,
            headings=headings,
            times=times,
            camera=seen_by,
            indices=self._first + np.arange(len(positions)),
            checksum=content_hash(self.images, *parts),
            geodetic=self.geodetic,
            heading_source="measured" if self._has_heading else "derived",
        )

    @cached_property
    def _table(self) -> CsvTable:
        table = read_csv(self.path, ["file", "time", *_LOCAL, *_GEODETIC, "heading_deg"])
        names = table.columns.keys()
        pairs = [pair for pair in (_LOCAL, _GEODETIC) if names & set(pair)]
        due = ["file", "time", *(pairs[0] if pairs else _LOCAL)]
        absent = [name for name in due if name not in names]
        if absent or len(pairs) > 1:
            fault = f"no column {absent[0]!r}" if absent else "positions of two kinds"
            pair = "either east and north or latitude and longitude"
            raise DataError(f"{self.path}, line 1: {fault}; the columns are file, time, {pair}, and heading_deg")
        if len(table.lines) < 2:
            raise DataError(f"{self.path}: {len(table.lines)} frames, and a drive has at least two")
        return table if self.frames is None else table.part(*self.frames)

    @property
    def _first(self) -> int:
        return 0 if self.frames is None else self.frames[0]

    @property
    def _has_heading(self) -> bool:
        return "heading_deg" in self._table.columns

    def _numbers(self, names: tuple[str, ...]) -> Float64[np.ndarray, "n columns"]:
        return np.stack([self._table.numbers(name) for name in names], axis=1)

    def _positions(self, origin: Float64[np.ndarray, "2"] | None) -> Float64[np.ndarray, "n 2"]:
        if self.geodetic is not None and origin is not None:
            return local_positions(self.geodetic, origin)
        if self.geodetic is not origin:
            fault = "latitude and longitude beside another drive's east and north, or the other way round"
            raise DataError(f"{self.path}: {fault}; give all drives of a route the same")
        return self._numbers(_LOCAL)

    def _times(self, positions: Float64[np.ndarray, "n 2"]) -> Float64[np.ndarray, " n"]:
        """Seconds; a step between frames that no road vehicle makes is refused."""
        times = self._table.numbers("time")
        check_increasing(times, self._table.where)
        check_speed(positions, times, self._table.where)
        return times

    def _headings(self, positions: Float64[np.ndarray, "n 2"]) -> Float64[np.ndarray, " n"]:
        """Radians in -pi..pi, clockwise from north."""
        if not self._has_heading:
            return derived_headings(positions, str(self.path), "add a column heading_deg")
        degrees = self._table.numbers("heading_deg")
        bad = np.flatnonzero(np.abs(degrees) > 360.0)
        if bad.size:
            where = self._table.where(int(bad[0]))
            raise DataError(f"{where}: heading_deg {degrees[bad[0]]:g} is not within 360 degrees")
        return wrap(np.radians(degrees))
