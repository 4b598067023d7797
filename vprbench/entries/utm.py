"""The catalogue entry for images that say in their names where they were taken."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from vprbench.availability import Need
from vprbench.entries.images import ImagesEntry, OwnPath, refuse_shared
from vprbench.errors import DataError
from vprbench.readers.utm_names import Order, UtmImages
from vprbench.route import HeadingSource, Route
from vprbench.truth import within

__all__ = ["UtmEntry"]


class UtmEntry(ImagesEntry):
    """A route whose database is learned and whose queries are the test; positions are in metres.

    Attributes:
        learn: the folder of the database.
        test: that of the queries.
        training: those of other roads.
        tolerance: a learn frame is right for a query within so many metres. 25 m is the benchmark's.
        order: what makes drives of the folders.
        headings: where they come from; None: measured if every name says one, else absent.
    """

    reader: Literal["utm"]
    learn: OwnPath
    test: OwnPath
    training: tuple[OwnPath, ...] = ()
    tolerance: Annotated[float, Field(ge=0)] = 25.0
    order: Order = "timestamp"
    headings: HeadingSource | None = None

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        return tuple(drive.need() for drive in self._drives())

    def read(self, name: str, root: Path) -> Route:
        """The route, with the benchmark's own truth, in metres from the first learn frame."""
        drives = self._drives()
        refuse_shared((drive.folder, drive.images) for drive in drives)
        first, second = drives[:2]
        if first.zone != second.zone:
            raise DataError(f"{first.folder} lies in UTM zone {first.zone} and {second.folder} in {second.zone}")
        source = self.headings or ("measured" if all(drive.has_headings for drive in drives) else "absent")
        origins = (first.utm[0], first.utm[0], *(drive.utm[0] for drive in drives[2:]))
        traverses = [
            drive.traverse(self.camera.reduced, origin, source) for drive, origin in zip(drives, origins, strict=True)
        ]
        learn, test, *training = traverses
        truth = within(learn.positions, test.positions, self.tolerance, "m")
        return Route(name, learn, test, tuple(training), self.environment, self.split, truth=truth)

    def _drives(self) -> tuple[UtmImages, ...]:
        # Images of such sets come from many cameras; only a focal length in pixels ties them to one.
        one_size = self.camera.field_of_view_deg is None
        folders = (self.learn, self.test, *self.training)
        return tuple(UtmImages(folder, self.order, one_size, self.crop) for folder in folders)
