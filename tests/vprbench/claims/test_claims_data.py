"""The claims as data: whole, consistent, and saying what the paper says."""

from __future__ import annotations

from collections import Counter

import pytest

from vprbench.catalogue import catalogue
from vprbench.claims.accuracy import AucDifference, AucGrowth, AucLevel, SpreadRatio
from vprbench.claims.learning import LearningRatio, LearningTime, RateDifference, SignatureSize
from vprbench.claims.model import Claim, load_claims
from vprbench.claims.reading import Reading, canonical
from vprbench.claims.rules import NOT_SUPPORTED, SUPPORTED, Beyond
from vprbench.claims.speed import Crossing, Frequency, FrequencyRatio
from vprbench.plugins import plugins
from vprbench.sweep import builtin_sweeps, load_sweep

CLAIMS = load_claims()
BY_ID = {claim.id: claim for claim in CLAIMS.claims}

# Read off the paper once more, apart from claims.toml: abstract, text and tables.
PAPER = {
    "length-k0-1": 378,
    "length-k5-1": 96,
    "length-k5-2": 199,
    "gps-mean": 0.79,
    "gps-sd": 0.98,
    "auc-15-30-over-lpmp": 10,
    "auc-24-over-18": 10,
    "auc-plateau-level": 85,
    "auc-15-30-over-cohog": 4,
    "global-over-lpmp": 7,
    "global-over-lpmp-5m": 8,
    "global-over-lpmp-2m": 5,
    "global-generalises": 8 - 5,
    "speed-at-least-twice-lpmp": 2,
    "speed-18-twice-lpmp": 2,
    "speed-15-30-over-lpmp": 1 + 0.80,
    "speed-24-under-18": 1 - 0.09,
    "speed-crossing": 15,
    "speed-24-twice-cohog": 2,
    "speed-24-hz": 10.5,
    "speed-cohog-hz": 5.5,
    "speed-15-30-over-cohog": 1 + 0.41,
    "learning-15-30-quicker": 1 / 2,
    **{f"spread-{over}-{agent}": 1 / 2 for over in ("routes", "distances") for agent in ("lpmp", "cohog")},
    **dict(
        zip(
            [f"learning-{size}" for size in ("12", "15", "18", "21", "24", "30", "15-30")],
            [132, 262, 313, 555, 555, 1527, 673],
            strict=True,
        )
    ),
    **dict(
        zip(
            [f"size-{size}" for size in ("lpmp", "12", "15", "18", "21", "24", "30", "15-30")],
            [2916, 36, 64, 81, 100, 144, 225, 225],
            strict=True,
        )
    ),
}


@pytest.mark.parametrize("claim", PAPER)
def test_the_values_are_the_papers(claim: str) -> None:
    assert BY_ID[claim].paper == pytest.approx(PAPER[claim])


def test_every_other_claim_is_of_an_equality_or_names_no_size() -> None:
    for claim in CLAIMS.claims:
        if claim.id not in PAPER:
            equal = 1 if claim.unit == "x" else 0
            assert claim.paper is None if isinstance(claim.rule, Beyond) else claim.paper == equal, claim.id


def test_ids_are_unique() -> None:
    ids = Counter([*BY_ID, *(entry.id for entry in CLAIMS.disclosures)])
    assert len(BY_ID) == len(CLAIMS.claims)
    assert ids.most_common(1)[0][1] == 1


def test_every_disclosure_touches_a_claim_and_every_one_named_is_there() -> None:
    named = {name for claim in CLAIMS.claims for name in claim.see}
    assert named == {entry.id for entry in CLAIMS.disclosures}


def test_every_road_is_in_the_catalogue() -> None:
    roads = {route for claim in CLAIMS.claims for route in claim.routes}
    roads |= {route for group in CLAIMS.stand_ins for route in group}
    assert roads <= set(catalogue().names())
    assert not roads & set(catalogue().names("tuning"))


def agents_of(claim: Claim) -> tuple[str, ...]:
    match claim.measure:
        case AucLevel(agents=agents):
            return agents
        case AucDifference() | AucGrowth() | SpreadRatio() | FrequencyRatio() | Crossing() as measure:
            return measure.agent, measure.reference
        case Frequency(agent=agent):
            return (agent,)
        case RateDifference() | LearningRatio() as measure:
            return measure.encoder, measure.reference
        case LearningTime() | SignatureSize() as measure:
            return (measure.encoder,)
    return ()


def test_every_agent_is_one_of_the_papers() -> None:
    hsd = {f"hsd-{size}" for size in ("12", "15", "18", "21", "24", "30", "15-30")}
    assert hsd <= set(plugins("encoder"))
    named = {agent for claim in CLAIMS.claims for agent in agents_of(claim)}
    assert named == hsd | {"lpmp", "cohog", "log-polar"}


@pytest.mark.parametrize("study", sorted({claim.study for claim in CLAIMS.claims} & {"auc-hsd", "global"}))
def test_the_sweeps_ask_for_every_agent_and_distance_that_is_judged(study: str) -> None:
    if study not in builtin_sweeps():
        pytest.skip(f"no built-in sweep {study} yet")
    sweep = load_sweep(study)[1]
    judged = [claim for claim in CLAIMS.claims if claim.study == study]
    assert {agent for claim in judged for agent in agents_of(claim)} <= {canonical(agent) for agent in sweep.agents}
    assert {2.0, 3.0, 5.0} <= set(sweep.sampling_distances)


@pytest.mark.parametrize("claim", [claim for claim in CLAIMS.claims if claim.measure.kind != "unmeasurable"])
def test_no_verdict_is_settled_beforehand(claim: Claim) -> None:
    """What the paper claims is supported when it is measured, and not when its opposite is."""
    if isinstance(claim.rule, Beyond):
        sign = 1 if claim.rule.side == "more" else -1
        claimed = claim.rule.than + sign * 0.1 if claim.paper is None else claim.paper
        assert sign * (claimed - claim.rule.than) > 0, "the claimed size lies on the claimed side"
        opposite = claim.rule.than - sign * 0.1
    else:
        claimed = claim.paper or 0.0
        opposite = claimed + 2 * claim.rule.margin + 1
    said = [claim.rule.judge(Reading(value, value, value, ""), claim.paper).verdict for value in (claimed, opposite)]
    assert said == [SUPPORTED, NOT_SUPPORTED]
