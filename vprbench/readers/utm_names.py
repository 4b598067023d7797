"""Images that say in their names where they were taken: the layout of VPR-datasets-downloader.

`@easting@northing@zone@letter@latitude@longitude@pano@tile@heading@pitch@roll@height@timestamp@note@.jpg`, of which
only the first two must say something, and the last may be missing. Berton et al., "Deep Visual Geo-localization
Benchmark", CVPR 2022.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float64

from vprbench.availability import Need
from vprbench.errors import DataError
from vprbench.geodesy import derived_headings, wrap
from vprbench.readers.crop import Crop
from vprbench.readers.images import ImageFiles, content_hash, image_files, image_size, optics
from vprbench.route import Camera, HeadingSource, Traverse

__all__ = ["Order", "UtmImages"]

# What the frames of a folder are ordered by; of equal ones, and throughout by "name", the file's name decides.
Order = Literal["timestamp", "note", "name"]

_FIELDS = (
    *("easting", "northing", "zone", "letter", "latitude", "longitude", "pano"),
    *("tile", "heading", "pitch", "roll", "height", "timestamp", "note"),
)
_REMEDY = "Arrange the data set with VPR-datasets-downloader there, which writes positions into the images' names."


class _Tagged(NamedTuple):
    """An image, and what its name says by field."""

    path: Path
    said: dict[str, str]

    def number(self, field: str) -> float:
        """A field as a finite number; DataError names the file."""
        try:
            value = float(self.said[field])
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise DataError(f"{self.path}: {field} is {self.said[field]!r}, not a finite number")
        return value


@dataclass(frozen=True)
class UtmImages:
    """The images of one folder, ordered.

    Attributes:
        folder: where they lie.
        order: what orders them.
        one_size: whether all must have the size of the first.
        crop: the band of the images that becomes the frame; None for all of them.
    """

    folder: Path
    order: Order = "timestamp"
    one_size: bool = True
    crop: Crop | None = None

    @property
    def images(self) -> tuple[Path, ...]:
        """The image of each frame, in order."""
        return tuple(tagged.path for tagged in self._tagged)

    @cached_property
    def utm(self) -> Float64[np.ndarray, "n 2"]:
        """Easting and northing of each frame, metres."""
        return np.array([[tagged.number("easting"), tagged.number("northing")] for tagged in self._tagged])

    @cached_property
    def zone(self) -> str:
        """The UTM zone and hemisphere of all frames; DataError where they lie in two: metres of two origins."""
        zones = {_zone(tagged.said): tagged.path for tagged in self._tagged}
        if len(zones) > 1:
            (one, _), (other, path) = list(zones.items())[:2]
            raise DataError(f"{path}: in UTM zone {other}, where others lie in {one}; split the data set by zone")
        return next(iter(zones))

    @property
    def has_headings(self) -> bool:
        """Whether every name says one."""
        return all(tagged.said["heading"] for tagged in self._tagged)

    def need(self) -> Need:
        """The images that are there."""
        if not self.folder.is_dir():
            return Need(str(self.folder), self.folder.parent, (), (), (self.folder,), _REMEDY)
        return Need(str(self.folder), self.folder, tuple(range(len(self._tagged))), (), (), _REMEDY)

    def traverse(
        self, camera: Callable[[int], Camera], origin: Float64[np.ndarray, "2"], headings: HeadingSource
    ) -> Traverse:
        """The frames as a drive.

        Args:
            camera: of the reduced frames, given the width of the images, pixels.
            origin: easting and northing of the position (0, 0).
            headings: where to take them from.
        """
        if len(self._tagged) < 2:
            raise DataError(f"{self.folder}: {len(self._tagged)} frames, and a drive has at least two")
        positions, size = self.utm - origin, image_size(self.images[0])
        turned, seen_by = self._headings(positions, headings), camera(size[0])
        return Traverse(
            name=f"{self.folder}, by {self.order}",
            frames=ImageFiles(self.images, size if self.one_size else None, crop=self.crop),
            positions=positions,
            headings=turned,
            times=np.arange(float(len(positions))),
            camera=seen_by,
            indices=np.arange(len(positions)),
            checksum=content_hash(self.images, self.utm, turned, *optics(seen_by, self.crop)),
            heading_source=headings,
        )

    @cached_property
    def _tagged(self) -> tuple[_Tagged, ...]:
        tagged = [_Tagged(path, _fields(path)) for path in image_files(self.folder)]
        if self.order == "name":
            return tuple(tagged)
        for one in tagged:
            if not one.said[self.order]:
                raise DataError(f'{one.path}: no {self.order} in its name to order it by; set order = "name"')
        return tuple(sorted(tagged, key=lambda one: (one.said[self.order], one.path.name)))

    def _headings(self, positions: Float64[np.ndarray, "n 2"], source: HeadingSource) -> Float64[np.ndarray, " n"]:
        """Radians in -pi..pi, clockwise from north; NaN where they are absent."""
        if source == "absent":
            return np.full(len(positions), np.nan)
        if source == "measured":
            return wrap(np.radians([tagged.number("heading") for tagged in self._tagged]))
        return derived_headings(positions, str(self.folder), 'set headings = "absent"')


def _zone(said: dict[str, str]) -> str:
    """The zone's number and hemisphere; within one, northings go on from one lettered band to the next."""
    hemisphere = ("north" if said["letter"].upper() >= "N" else "south") if said["letter"] else ""
    return f"{said['zone'].lstrip('0')} {hemisphere}".strip()


def _fields(path: Path) -> dict[str, str]:
    start, *words = map(str.strip, path.name.split("@")[:-1] or ["none"])
    if start or not 2 <= len(words) <= len(_FIELDS):
        due = "@".join(("", *_FIELDS, path.suffix))
        raise DataError(f"{path}: its name does not say where it was taken; names are {due}")
    return dict(zip(_FIELDS, [*words, *[""] * (len(_FIELDS) - len(words))], strict=True))
