"""The catalogue entry for data sets in the layout of VPR-Bench."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from vprbench.availability import Need
from vprbench.entries.images import ImagesEntry, OwnCamera, OwnPath, refuse_shared
from vprbench.entries.index import UNSEEN_CAMERA
from vprbench.readers.numbered import NumberedImages
from vprbench.readers.vpr_bench import read_matches
from vprbench.route import Route
from vprbench.truth import listed

__all__ = ["VprBenchEntry"]


class VprBenchEntry(ImagesEntry):
    """A route whose references are learned and whose queries are the test; positions are in frames.

    Attributes:
        folder: holds `ref/`, `query/` and the ground truth.
        ground_truth: the name of its file.
        training: folders of images of other roads, for example the `ref/` of another data set.
        camera: of all images; without headings nothing of ours asks for it.
    """

    reader: Literal["vpr-bench"]
    folder: OwnPath
    ground_truth: str = "ground_truth_new.npy"
    training: tuple[OwnPath, ...] = ()
    camera: OwnCamera = UNSEEN_CAMERA

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        truth = self._truth
        absent = () if truth.is_file() else (truth,)
        remedy = f"Put VPR-Bench's {self.ground_truth} beside the data set's query and ref."
        return (*(drive.need() for drive in self._drives()), Need(str(truth), self.folder, (), (), absent, remedy))

    def read(self, name: str, root: Path) -> Route:
        """The route, with the data set's own truth."""
        drives = self._drives()
        refuse_shared((drive.folder, tuple(drive.images.values())) for drive in drives)
        learn, test, *training = (drive.traverse(self.camera.reduced) for drive in drives)
        marks = read_matches(self._truth, test.indices, learn.indices)
        truth = listed(learn.positions, marks, self.ground_truth)
        return Route(name, learn, test, tuple(training), self.environment, self.split, "frames", truth)

    @property
    def _truth(self) -> Path:
        return self.folder / self.ground_truth

    def _drives(self) -> tuple[NumberedImages, ...]:
        folders = (self.folder / "ref", self.folder / "query", *self.training)
        # Images of such sets come from many cameras; only a focal length in pixels ties them to one.
        one_size = self.camera.field_of_view_deg is None
        return tuple(NumberedImages(folder, one_size=one_size, crop=self.crop) for folder in folders)
