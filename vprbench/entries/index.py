"""The catalogue entry for data sets whose truth is the number of a frame: Gardens Point Walking, Nordland."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, ValidationInfo

from vprbench.availability import Need
from vprbench.entries.images import ImagesEntry, OwnCamera, beside_the_file, refuse_shared
from vprbench.readers.numbered import NumberedImages
from vprbench.route import Route
from vprbench.truth import within

__all__ = ["UNSEEN_CAMERA", "IndexEntry", "Numbered"]

# Where there are no headings, nothing of ours asks for the camera. Our choice.
UNSEEN_CAMERA = OwnCamera(field_of_view_deg=60.0)

_RUN = re.compile(r"(?P<folder>.+):(?P<first>\d{1,6})-(?P<last>\d{1,6})", re.ASCII)


def _numbered(text: object, info: ValidationInfo) -> NumberedImages:
    """Read "folder" or "folder:first-last"; ValueError where it is neither."""
    if not isinstance(text, str):
        raise ValueError(f'{text!r} is neither "folder" nor "folder:first-last"')
    match = _RUN.fullmatch(text)
    if match is None:
        return NumberedImages(beside_the_file(Path(text), info))
    first, last = int(match["first"]), int(match["last"])
    if first >= last:
        raise ValueError(f"{text!r} ends before it has two frames")
    return NumberedImages(beside_the_file(Path(match["folder"]), info), first, last)


Numbered = Annotated[NumberedImages, BeforeValidator(_numbered)]


class IndexEntry(ImagesEntry):
    """A route whose frame t of one drive shows what frame t of the other does; positions are in frames.

    Attributes:
        learn: the folder of the learn drive, "day_left", or a run of its frames, "day_left:0-99".
        test: that of the test drive.
        training: those of drives off the route.
        tolerance: a learn frame is right for a query whose number differs by at most so many frames.
        every: only frames whose number is a multiple of this.
        camera: of all drives; without headings nothing of ours asks for it.
    """

    reader: Literal["index"]
    learn: Numbered
    test: Numbered
    training: tuple[Numbered, ...] = ()
    tolerance: Annotated[float, Field(ge=0)]
    every: Annotated[int, Field(ge=1)] = 1
    camera: OwnCamera = UNSEEN_CAMERA

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        return tuple(drive.need() for drive in self._drives())

    def read(self, name: str, root: Path) -> Route:
        """The route, with the data set's own truth."""
        drives = self._drives()
        refuse_shared((Path(drive.name), tuple(drive.images.values())) for drive in drives)
        learn, test, *training = (drive.traverse(self.camera.reduced) for drive in drives)
        truth = within(learn.positions, test.positions, self.tolerance, "frames")
        return Route(name, learn, test, tuple(training), self.environment, self.split, "frames", truth)

    def _drives(self) -> tuple[NumberedImages, ...]:
        drives = (self.learn, self.test, *self.training)
        return tuple(replace(drive, every=self.every, crop=self.crop) for drive in drives)
