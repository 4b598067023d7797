"""Every claim of the paper judged by what was measured: one row a claim."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from vprbench.claims.model import Claim, load_claims
from vprbench.claims.reading import Evidence, Reading
from vprbench.claims.rules import NOT_TESTABLE, VERDICTS, Verdict
from vprbench.errors import DataError, VprbenchError

__all__ = ["COLUMNS", "count_verdicts", "evaluate", "judge"]

COLUMNS = ("id", "where", "claim", "paper", "ours", "low", "high", "unit", "verdict", "measured_on", "note")

NOTHING = Reading(float("nan"), float("nan"), float("nan"), "")

_BOUND = {
    "road": "an absolute score belongs to its road, which was not measured",
    "machine": "an absolute time belongs to the paper's machine and code",
}


def evaluate(folder: Path, data: Path | None = None) -> pd.DataFrame:
    """Judge every claim by the results in a folder; the columns are `COLUMNS`.

    Files that are not there, and agents, roads or numbers that are not in them, leave the claims that need them
    untested, each with the reason.

    Args:
        folder: of STUDY.csv with traces (auc-hsd, global), fit.csv, fit-timings.json and frequency.csv.
        data: the data root, for the roads that claims speak of.

    Raises:
        DataError: there is no such folder.
    """
    if not folder.is_dir():
        raise DataError(f"{folder}: no such folder; name the one that holds the tables of the studies")
    asked = load_claims()
    evidence = Evidence(folder, data, asked.stand_ins)
    return pd.DataFrame([judge(claim, evidence) for claim in asked.claims], columns=list(COLUMNS))


def judge(claim: Claim, evidence: Evidence) -> dict[str, object]:
    """The row of one claim."""
    reading, verdict = _judged(claim, evidence)
    see = f"see {', '.join(claim.see)}" if claim.see else ""
    return {
        "id": claim.id,
        "where": "; ".join(claim.where),
        "claim": claim.claim,
        "paper": float("nan") if claim.paper is None else claim.paper,
        "ours": reading.value,
        "low": reading.low,
        "high": reading.high,
        "unit": claim.unit,
        "verdict": verdict.verdict,
        "measured_on": reading.measured_on,
        "note": "; ".join(filter(None, (verdict.note, reading.remark, see))),
    }


def count_verdicts(table: pd.DataFrame) -> dict[str, int]:
    """How many claims got each verdict, also those that none got."""
    return {verdict: int((table["verdict"] == verdict).sum()) for verdict in VERDICTS}


def _judged(claim: Claim, evidence: Evidence) -> tuple[Reading, Verdict]:
    """What was measured of a claim, and the verdict on it."""
    try:
        reading = claim.measure.read(evidence, claim.study, claim.routes)
    except VprbenchError as error:
        return NOTHING, Verdict(NOT_TESTABLE, str(error))
    if claim.bound_to == "machine" or (claim.bound_to == "road" and not reading.at_home):
        return reading, Verdict(NOT_TESTABLE, _BOUND[claim.bound_to])
    return reading, claim.rule.judge(reading, claim.paper)
