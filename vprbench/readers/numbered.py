"""Folders of images whose names end in their frames' numbers, of which nothing but these is known.

Such are Gardens Point Walking (Glover, 2014; day_left, day_right, night_right), Nordland (Sunderhauf, Neubert,
Protzel, "Are we there yet? Challenging SeqSLAM on a 3000 km journey across all four seasons", ICRA workshop 2013), and
the query/ and ref/ of VPR-Bench. Positions are (0, number), in frames; numbers stand in for the times too.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from vprbench.availability import Need, need_of
from vprbench.errors import DataError
from vprbench.readers.crop import Crop
from vprbench.readers.images import ImageFiles, content_hash, image_files, image_size, optics
from vprbench.route import Camera, Traverse

__all__ = ["NumberedImages"]

_REMEDY = "Put the images there, their numbers at the end of their names."


@dataclass(frozen=True)
class NumberedImages:
    """The numbered images of one folder, or a run of them.

    Attributes:
        folder: where they lie.
        first: number of the first frame; None: the lowest there is.
        last: number of the last frame; None: the highest there is.
        every: only frames whose number is a multiple of this.
        one_size: whether all must have the size of the first.
        crop: the band of the images that becomes the frame; None for all of them.
    """

    folder: Path
    first: int | None = None
    last: int | None = None
    every: int = 1
    one_size: bool = True
    crop: Crop | None = None

    @property
    def name(self) -> str:
        """The folder, and which of its frames."""
        run = "" if self.first is None else f":{self.first}-{self.last}"
        return f"{self.folder}{run}{f', every {self.every}' if self.every > 1 else ''}"

    @cached_property
    def images(self) -> Mapping[int, Path]:
        """The image of each frame by its number, in order; DataError where a number is none, or stands twice."""
        found: dict[int, Path] = {}
        for path in image_files(self.folder):
            number = _number(path)
            other = found.setdefault(number, path)
            if other != path:
                raise DataError(f"{path}: frame {number}, as is {other.name}; keep one of them")
        return {number: found[number] for number in sorted(found) if self._asked(number)}

    def need(self) -> Need:
        """The frames of the run, or those that are there where no run is named."""
        if not self.folder.is_dir():
            return Need(str(self.folder), self.folder.parent, (), (), (self.folder,), _REMEDY)
        numbers = self.images if self.first is None or self.last is None else range(self.first, self.last + 1)
        asked = filter(self._asked, numbers)
        files = {number: (self.images.get(number, self.folder / f"{number}, of any name"),) for number in asked}
        return need_of(str(self.folder), self.folder, files, (), _REMEDY)

    def traverse(self, camera: Callable[[int], Camera]) -> Traverse:
        """The drive; it has no headings.

        Args:
            camera: of the reduced frames, given the width of the images, pixels.
        """
        if len(self.images) < 2:
            raise DataError(f"{self.name}: {len(self.images)} frames, and a drive has at least two")
        paths, numbers = tuple(self.images.values()), np.array(list(self.images))
        size = image_size(paths[0])
        seen_by = camera(size[0])
        positions = np.column_stack([np.zeros(len(numbers)), numbers.astype(np.float64)])
        return Traverse(
            name=self.name,
            frames=ImageFiles(paths, size if self.one_size else None, crop=self.crop),
            positions=positions,
            headings=np.full(len(numbers), np.nan),
            times=numbers.astype(np.float64),
            camera=seen_by,
            indices=numbers,
            checksum=content_hash(paths, positions, *optics(seen_by, self.crop)),
            heading_source="absent",
        )

    def _asked(self, number: int) -> bool:
        inside = self.first is None or self.last is None or self.first <= number <= self.last
        return inside and number % self.every == 0


def _number(path: Path) -> int:
    digits = re.findall(r"\d+", path.stem, re.ASCII)
    if not digits:
        raise DataError(f"{path}: no number in its name to say which frame it is; rename it, or take it away")
    return int(digits[-1])
