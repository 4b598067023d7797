"""A claim as data: what the paper says, where, what is measured of it, and by which rule it is judged."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from vprbench.claims.accuracy import AucDifference, AucGrowth, AucLevel, SpreadRatio
from vprbench.claims.learning import LearningRatio, LearningTime, RateDifference, SignatureSize
from vprbench.claims.reading import Evidence, Measurement, Reading, Untestable
from vprbench.claims.roads import NearestDistance, RouteLength
from vprbench.claims.rules import Around, Beyond
from vprbench.claims.speed import Crossing, Frequency, FrequencyRatio

__all__ = ["Claim", "Claims", "Disclosure", "Measure", "Unmeasurable", "load_claims"]


class _Data(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Unmeasurable(Measurement):
    """What no measurement can decide.

    Attributes:
        reason: why.
    """

    kind: Literal["unmeasurable"]
    reason: str

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """Always Untestable."""
        raise Untestable(self.reason)


Measure = Annotated[
    AucDifference
    | AucGrowth
    | AucLevel
    | SpreadRatio
    | RateDifference
    | LearningTime
    | LearningRatio
    | SignatureSize
    | Frequency
    | FrequencyRatio
    | Crossing
    | RouteLength
    | NearestDistance
    | Unmeasurable,
    Field(discriminator="kind"),
]


class Claim(_Data):
    """One quantitative claim.

    Attributes:
        id: short and unique.
        where: in the paper, every place that makes it.
        claim: in our words.
        paper: the claimed value; None where the paper names none.
        unit: of the values.
        study: whose results decide it.
        routes: roads that it speaks of.
        measure: what is measured.
        rule: by which it is judged.
        bound_to: what an absolute value belongs to, without which it cannot be tested: the paper's own roads, or its
            own machine and code.
        see: disclosures that touch it.
    """

    id: str
    where: tuple[str, ...]
    claim: str
    paper: float | None = None
    unit: str
    study: Literal["auc-hsd", "global", "fit", "frequency", "routes"]
    routes: tuple[str, ...] = ()
    measure: Measure
    rule: Annotated[Beyond | Around, Field(discriminator="kind")]
    bound_to: Literal["road", "machine"] | None = None
    see: tuple[str, ...] = ()


class Disclosure(_Data):
    """Where the paper contradicts itself or its data, or leaves open what it means.

    Attributes:
        id: short and unique.
        text: what a reader of the claims that it touches must know.
    """

    id: str
    text: str


class Claims(_Data):
    """All claims of the paper.

    Attributes:
        source: the paper.
        stand_ins: groups of roads, each of which may be measured in the place of the paper's, the best first.
        disclosures: in the order of the paper.
        claims: in the order of the paper.
    """

    source: str
    stand_ins: tuple[tuple[str, ...], ...]
    disclosures: tuple[Disclosure, ...]
    claims: tuple[Claim, ...]


@cache
def load_claims() -> Claims:
    """The claims that come with vprbench."""
    return Claims.model_validate(tomllib.loads((files("vprbench.claims") / "claims.toml").read_text("utf-8")))
