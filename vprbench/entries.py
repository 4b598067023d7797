"""Catalogue entries: what a route is made of, as data, one kind for each reader."""

from __future__ import annotations

from collections import defaultdict
from itertools import combinations
from pathlib import Path
from typing import Annotated, Literal, Protocol

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from vprbench.availability import Need
from vprbench.frame_ranges import FrameRun
from vprbench.readers.kitti import OdometryCamera, OdometrySequence
from vprbench.route import Route, Traverse

__all__ = ["KittiOdometryEntry", "RouteEntry", "Split"]

Split = Literal["report", "tuning", "control"]

Run = Annotated[FrameRun, BeforeValidator(lambda v: FrameRun.parse(v) if isinstance(v, str) else v)]


class Entry(BaseModel):
    """What every entry states about its route."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, arbitrary_types_allowed=True)

    environment: str = ""
    split: Split = "report"


class _Recording(Protocol):
    def need(self, frames: list[int]) -> Need: ...
    def traverse(self, run: FrameRun) -> Traverse: ...


class _RunsEntry(Entry):
    """A route whose drives are runs of frames of numbered recordings."""

    learn: Run
    test: Run
    training: tuple[Run, ...] = ()

    @model_validator(mode="after")
    def _disjoint(self) -> _RunsEntry:
        """A frame that is learned and tested would be recognised for nothing."""
        for a, b in combinations((self.learn, self.test, *self.training), 2):
            if a.sequence == b.sequence and a.first <= b.last and b.first <= a.last:
                raise ValueError(f'"{a}" and "{b}" share frames')
        return self

    def _runs(self) -> tuple[FrameRun, ...]:
        return (self.learn, self.test, *self.training)

    def frames(self) -> dict[str, list[int]]:
        """The frames needed of each sequence."""
        needed: dict[str, list[int]] = defaultdict(list)
        for run in self._runs():
            needed[run.sequence].extend(run.frames)
        return needed


class KittiOdometryEntry(_RunsEntry):
    """A route in the KITTI odometry benchmark.

    Attributes:
        learn: the frames of the learn drive.
        test: those of the test drive, in the same sequence: poses of two sequences have no common origin.
        training: drives off the route.
        camera: the folder of images to use.
    """

    reader: Literal["kitti-odometry"]
    camera: OdometryCamera = "image_0"

    @model_validator(mode="after")
    def _one_sequence(self) -> KittiOdometryEntry:
        if self.learn.sequence != self.test.sequence:
            raise ValueError("learn and test must lie in one sequence: the poses of two have no common origin")
        return self

    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk."""
        return tuple(OdometrySequence(root, s, self.camera).need(f) for s, f in self.frames().items())

    def load(self, name: str, root: Path) -> Route:
        """The route; its frames stay on disk until asked for."""
        sequences = {s: OdometrySequence(root, s, self.camera) for s in self.frames()}
        learn, test, *training = (sequences[run.sequence].traverse(run) for run in self._runs())
        return Route(name, learn, test, tuple(training), self.environment, self.split)


RouteEntry = Annotated[KittiOdometryEntry, Field(discriminator="reader")]
