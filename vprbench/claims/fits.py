"""What encoders learned and how long that took, by seed: the files that `vprbench fit` leaves."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from vprbench.bootstrap import LEVEL, student_quantile
from vprbench.claims.reading import Evidence, Untestable, canonical
from vprbench.errors import DataError

__all__ = ["Fits", "find_measure", "find_seconds", "mean_interval"]


@dataclass(frozen=True)
class Fits:
    """One number of one encoder for each seed that was fitted.

    Attributes:
        by_seed: at least one.
        route: whose training drives it learned from.
        machine: that it was timed on; empty for what no machine decides.
    """

    by_seed: Mapping[int, float]
    route: str
    machine: str = ""

    def paired(self, other: Fits) -> list[tuple[float, float]]:
        """This number and another's, for each seed that both have."""
        return [(self.by_seed[seed], other.by_seed[seed]) for seed in sorted(self.by_seed) if seed in other.by_seed]


def find_measure(evidence: Evidence, encoder: str, measure: str) -> Fits:
    """A measure from fit.csv; Untestable where it is not there."""
    path = evidence.folder / "fit.csv"
    if not path.exists():
        raise Untestable("no fit.csv: vprbench fit makes it")
    try:
        table = pd.read_csv(path)
        rows = table[table["encoder"].map(canonical) == encoder]
        known = rows.dropna(subset=measure) if measure in rows else rows.iloc[:0]
        by_seed = {int(row["seed"]): float(row[measure]) for row in known.to_dict("records")}
        routes = sorted(set(known["route"].astype(str)))
    except (OSError, ValueError, KeyError) as error:
        raise DataError(f"{path}: not readable as a table of fits: {error}") from error
    if not by_seed:
        raise Untestable(f"fit.csv has no {measure} of {encoder}")
    return Fits(by_seed, ", ".join(routes))


def find_seconds(evidence: Evidence, encoder: str) -> Fits:
    """Seconds of learning from fit-timings.json; Untestable where they are not there."""
    path = evidence.folder / "fit-timings.json"
    if not path.exists():
        raise Untestable("no fit-timings.json: vprbench fit --refit makes it")
    try:
        entries = [entry for entry in _entries(path.read_text("utf-8")) if canonical(entry["encoder"]) == encoder]
        by_seed = {int(entry["seed"]): float(entry["seconds"]["fit_seconds"]) for entry in entries}
        routes = sorted({str(entry["route"]) for entry in entries})
        machines = sorted({str(entry["machine"]["processor"]) for entry in entries})
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise DataError(f"{path}: not readable as timings of fits: {error}") from error
    if not by_seed:
        raise Untestable(f"fit-timings.json has no timing of {encoder}")
    if len(machines) > 1:
        raise Untestable(f"fit-timings.json times {encoder} on several machines")
    return Fits(by_seed, ", ".join(routes), machines[0])


def mean_interval(values: list[float]) -> tuple[float, float, float]:
    """The mean over seeds and its 95 % interval by Student's t; NaN ends where there is but one."""
    mean, count = float(np.mean(values)), len(values)
    if count < 2:
        return mean, float("nan"), float("nan")
    half = student_quantile((1 + LEVEL) / 2, count - 1.0) * float(np.std(values, ddof=1)) / count**0.5
    return mean, mean - half, mean + half


def _entries(text: str) -> list[dict[str, Any]]:
    return list(json.loads(text)["fits"])
