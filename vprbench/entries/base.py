"""What every catalogue entry states, and the entries made of runs of numbered frames."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from vprbench.availability import Need
from vprbench.entries.compass import noisy_compass
from vprbench.frame_ranges import FrameRun, format_ranges
from vprbench.route import Route

__all__ = ["Entry", "Run", "RunsEntry", "Split"]

Split = Literal["report", "tuning", "control"]


def _run(value: object) -> object:
    return FrameRun.parse(value) if isinstance(value, str) else value


Run = Annotated[FrameRun, BeforeValidator(_run)]


class Entry(BaseModel, ABC):
    """What every entry states about its route.

    Attributes:
        environment: the kind of road.
        split: "report" for results, "tuning" for choosing parameters, "control" for one question.
        heading_noise_deg: standard deviation of the error of the test drive's headings, degrees, each frame's apart.
        heading_noise_seed: says which errors.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    environment: str = ""
    split: Split = "report"
    heading_noise_deg: Annotated[float, Field(ge=0, le=360)] = 0.0
    heading_noise_seed: Annotated[int, Field(ge=0)] = 0

    @abstractmethod
    def needs(self, root: Path) -> tuple[Need, ...]:
        """What must be on disk, under the data root or elsewhere."""

    @abstractmethod
    def read(self, name: str, root: Path) -> Route:
        """The route as recorded; its frames stay on disk until they are asked for."""

    def load(self, name: str, root: Path) -> Route:
        """The route, its test drive's compass as good as the entry says."""
        route = self.read(name, root)
        if not self.heading_noise_deg:
            return route
        return replace(route, test=noisy_compass(route.test, self.heading_noise_deg, self.heading_noise_seed))


class RunsEntry(Entry):
    """A route whose drives are runs of frames of numbered recordings.

    Attributes:
        learn: the frames of the learn drive.
        test: those of the test drive.
        training: those of drives off the route.
    """

    learn: Run
    test: Run
    training: tuple[Run, ...] = ()

    @property
    def runs(self) -> tuple[FrameRun, ...]:
        """The runs of the learn drive, the test drive and the training drives."""
        return (self.learn, self.test, *self.training)

    def frames(self) -> Mapping[str, list[int]]:
        """The frames needed of each recording."""
        needed: dict[str, list[int]] = defaultdict(list)
        for run in self.runs:
            needed[run.sequence].extend(run.frames)
        return needed

    @model_validator(mode="after")
    def _disjoint(self) -> RunsEntry:
        """A frame that is both learned and tested, or trained on, would be recognised for nothing."""
        for a, b in combinations(self.runs, 2):
            first, last = max(a.first, b.first), min(a.last, b.last)
            if a.sequence == b.sequence and first <= last:
                shared = format_ranges(range(first, last + 1))
                raise ValueError(f'"{a}" and "{b}" share frames {shared}; leave them out of one')
        return self
