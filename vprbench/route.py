"""A drive (Traverse) and a pair of drives over the same road (Route)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float64, Int64

from vprbench.errors import DataError
from vprbench.truth import Revisit, revisit
from vprbench.types import Frame

__all__ = ["Camera", "FrameSource", "HeadingSource", "Route", "Traverse", "Unit"]

# What positions and sampling distances are in: metres, or frames where a data set knows only their numbers.
Unit = Literal["m", "frames"]

# Where headings come from: an instrument, the direction of the positions, or nowhere.
HeadingSource = Literal["measured", "derived", "absent"]


@runtime_checkable
class FrameSource(Protocol):
    """Frames on demand: nothing is read or drawn until it is asked for."""

    def __getitem__(self, index: int, /) -> Frame:
        """Frame `index`, grey uint8 (188, 642); a fresh array at every call."""
        ...


@dataclass(frozen=True)
class Camera:
    """The pinhole camera of the resized frames: focal length and principal column, pixels."""

    fx: float
    cx: float


@dataclass(frozen=True)
class Traverse:
    """One drive along a road: lazy frames, and where and when each was taken.

    Attributes:
        name: what to call it in messages, for example "KITTI 00, frames 113-205".
        frames: frame t on demand.
        positions: (n, 2) local east and north, metres; of a route in frames, 0 and the frame's number.
        headings: (n,) radians in -pi..pi, clockwise from north; NaN where they are absent.
        times: (n,) seconds, increasing.
        camera: of the resized frames.
        indices: (n,) each frame's number in its data set.
        geodetic: (n, 2) latitude and longitude, degrees; None where the data set has none.
        checksum: sha256 of what defines the drive (poses, frame files or drawing parameters).
        heading_source: where the headings come from.
    """

    name: str
    frames: FrameSource
    positions: Float64[np.ndarray, "n 2"]
    headings: Float64[np.ndarray, " n"]
    times: Float64[np.ndarray, " n"]
    camera: Camera
    indices: Int64[np.ndarray, " n"]
    checksum: str
    geodetic: Float64[np.ndarray, "n 2"] | None = None
    heading_source: HeadingSource = "measured"

    def __post_init__(self) -> None:
        """Refuse arrays that differ in length or hold a value that is not finite."""
        for label in ("positions", "headings", "times", "indices"):
            values = getattr(self, label)
            if len(values) != len(self.positions):
                raise DataError(f"{self.name}: {len(values)} {label} for {len(self.positions)} positions")
            bad = np.flatnonzero(~np.isfinite(values.reshape(len(values), -1)).all(axis=1))
            if bad.size and not (label == "headings" and self.heading_source == "absent"):
                raise DataError(f"{self.name}: {label} of frame {self.indices[bad[0]]} is not finite")

    def __len__(self) -> int:
        return len(self.positions)

    @cached_property
    def distance(self) -> Float64[np.ndarray, " n"]:
        """Distance driven up to each frame, in the unit of the positions."""
        steps = np.linalg.norm(np.diff(self.positions, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def length(self) -> float:
        """Distance driven from the first frame to the last, in the unit of the positions."""
        return float(self.distance[-1])

    def named(self, name: str) -> Traverse:
        """The same drive under another name."""
        return replace(self, name=name)


@dataclass(frozen=True)
class Route:
    """One road driven twice, and the drives elsewhere on which an agent may train.

    Attributes:
        name: as in `vprbench list`, for example "KITTI-K0-2".
        learn: the drive that memorises places.
        test: the drive that must recognise them.
        training: drives off the route, for dictionaries and calibration.
        environment: the kind of road, as the paper names it.
        split: "report" for results, "tuning" for choosing parameters, "control" to answer one question.
        unit: what positions and sampling distances are in.
        truth: which learn frames are right for each test frame, where the data set says so itself; None: by d_NN.

    Raises:
        DataError: a truth of other drives, or headings that some drives have and others lack.
    """

    name: str
    learn: Traverse
    test: Traverse
    training: Sequence[Traverse]
    environment: str = ""
    split: str = "report"
    unit: Unit = "m"
    truth: Revisit | None = None

    def __post_init__(self) -> None:
        if self.truth is not None and self.truth.answers.shape != (len(self.test), len(self.learn)):
            raise DataError(
                f"{self.name}: a truth for {self.truth.answers.shape} test and learn frames, but the drives have "
                f"{(len(self.test), len(self.learn))}"
            )
        if len({drive.heading_source == "absent" for drive in (self.learn, self.test, *self.training)}) > 1:
            raise DataError(f"{self.name}: some of its drives have headings and others none; give all or none")

    @cached_property
    def visit(self) -> Revisit:
        """How the test drive lies beside the learn drive: by the data set's own truth, else by d_NN."""
        return self.truth or revisit(self.learn.positions, self.test.positions)
