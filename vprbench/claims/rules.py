"""When a claim is supported: two rules, and the verdicts that they give.

`Beyond` judges a claim that one thing exceeds another, perhaps by a stated size. It is supported when the 95 %
interval lies on the claimed side of equality and does not exclude the claimed size from below: it need not hold the
size, it may lie beyond it. `Around` judges a claim of a value (or of equality, which is a difference of 0). It is
supported when the whole interval lies within a stated margin of the value.

"Not supported" says what these data show, not that the claim is false; the note tells the two apart.
"""

from __future__ import annotations

from math import isnan
from typing import Literal, NamedTuple

from pydantic import BaseModel, ConfigDict

from vprbench.claims.reading import Reading

__all__ = ["NOT_SUPPORTED", "NOT_TESTABLE", "RULES", "SUPPORTED", "VERDICTS", "Around", "Beyond", "Verdict"]

VERDICTS = (SUPPORTED, NOT_SUPPORTED, NOT_TESTABLE) = (
    "supported",
    "not supported",
    "not testable on the data present",
)

# Said wherever verdicts are shown.
RULES = (
    "Intervals are 95 %: of AUC paired block bootstrap over stretches of road and seeds, of learning Student's t over "
    "seeds; of frequencies they are the quartiles of rounds. Roads and sizes have none. Each claim stands by itself.",
    "A claimed difference or ratio is supported when its interval lies on the claimed side of equality and reaches the "
    "claimed size; a claimed value or equality, when the interval lies within the stated margin of it.",
    "Not supported means that these data do not show it; the note says whether they show the opposite, the direction "
    "only, or no difference.",
    "Where a stand-in was measured for the paper's roads, the verdict is about the stand-in. What belongs to the "
    "paper's own machine or road is not testable without it; ours is shown all the same.",
)


class Verdict(NamedTuple):
    """One of `VERDICTS`, and what there is to say of it."""

    verdict: str
    note: str = ""


class _Rule(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Beyond(_Rule):
    """The claim that a value lies on one side of equality.

    Attributes:
        side: the claimed one.
        than: what equality is: 0 of a difference, 1 of a ratio.
    """

    kind: Literal["beyond"]
    side: Literal["more", "less"]
    than: float = 0.0

    def judge(self, reading: Reading, paper: float | None) -> Verdict:
        """The verdict; `paper` is the claimed value, None where the paper names no size."""
        if isnan(reading.low) or isnan(reading.high):
            return Verdict(NOT_TESTABLE, "too few data for an interval")
        sign = 1.0 if self.side == "more" else -1.0
        near, far = sorted((sign * (reading.low - self.than), sign * (reading.high - self.than)))
        if near <= 0:
            return Verdict(NOT_SUPPORTED, "the opposite is shown" if far < 0 else "no difference shown")
        size = 0.0 if paper is None else sign * (paper - self.than)
        if far < size:
            return Verdict(NOT_SUPPORTED, "direction only: less than the claimed size")
        return Verdict(SUPPORTED, "more than the claimed size" if 0 < size < near else "")


class Around(_Rule):
    """The claim that something has a value, or that two things are equal.

    Attributes:
        margin: how far from the value still counts as it, in the unit of the claim.
    """

    kind: Literal["around"]
    margin: float

    def judge(self, reading: Reading, paper: float | None) -> Verdict:
        """The verdict; `paper` is the claimed value, None for 0."""
        if isnan(reading.low) or isnan(reading.high):
            return Verdict(NOT_TESTABLE, "too few data for an interval")
        low, high = reading.low - (paper or 0.0), reading.high - (paper or 0.0)
        if -self.margin <= low and high <= self.margin:
            return Verdict(SUPPORTED)
        if low > 0 or high < 0:
            return Verdict(NOT_SUPPORTED, "another value is shown" if paper else "a difference is shown")
        return Verdict(NOT_SUPPORTED, f"the interval is wider than the margin of {self.margin:g}")
