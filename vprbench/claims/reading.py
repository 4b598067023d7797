"""What was measured of a claim, before it is judged."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from vprbench.errors import VprbenchError

__all__ = ["Evidence", "Measurement", "Reading", "Untestable", "canonical"]


class Untestable(VprbenchError):
    """Why a claim cannot be tested on the data present."""


@dataclass(frozen=True)
class Reading:
    """A measured value with its interval, in the unit of the claim.

    Attributes:
        value: as measured.
        low: lower end of the interval; NaN where the data give none.
        high: upper end of it.
        measured_on: roads, cells, seeds or machine that it comes from.
        at_home: whether those are the roads that the claim speaks of.
        remark: what else to know of it.
    """

    value: float
    low: float
    high: float
    measured_on: str
    at_home: bool = True
    remark: str = ""


@dataclass(frozen=True)
class Evidence:
    """Where to look for what was measured.

    Attributes:
        folder: of the result tables.
        data: the data root, for roads; None for the default.
        stand_ins: groups of roads, each of which may be measured in the place of the paper's, the best first.
    """

    folder: Path
    data: Path | None = None
    stand_ins: Sequence[Sequence[str]] = ()


class Measurement(BaseModel, ABC):
    """What is measured of a claim: the parameters of a pure function from results to a reading."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @abstractmethod
    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The reading, in the unit of the claim.

        Args:
            evidence: where to look.
            study: whose results decide the claim.
            routes: roads that the claim speaks of.

        Raises:
            Untestable: what it needs was not measured.
            DataError: a file is damaged.
        """


def canonical(name: str) -> str:
    """An agent's name however it is written: "HSD-15/30" and "hsd-15-30" are one."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
