"""A folder of results made by hand, so that every score is known beforehand."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from vprbench.claims.reading import Evidence
from vprbench.columns import COLUMNS
from vprbench.results import ResultTable
from vprbench.sweep import Cell
from vprbench.trace import Trace

QUERIES = 200


def even(right: int) -> np.ndarray:
    """So many right answers in every ten metres: each block of ten holds as many, and an interval has no width."""
    return np.arange(QUERIES) % 10 < right


def trace_of(correct: np.ndarray) -> Trace:
    """A straight drive of 1 m a query, every answer as sure: its AUC is (1 + accuracy) / 2."""
    size = len(correct)
    return Trace(
        frame=np.arange(size),
        truth=np.arange(size),
        hypothesis=np.arange(size),
        confidence=np.ones(size),
        error_m=np.zeros(size),
        tolerance_m=np.zeros(size),
        correct=correct,
        correct_metric=correct,
        rank=np.where(correct, 0, -1),
        rank_metric=np.where(correct, 0, -1),
        east=np.arange(size, dtype=float),
        north=np.zeros(size),
    )


class Results:
    """Writes the files that claims are judged by."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @property
    def evidence(self) -> Evidence:
        """The folder, with one real road and two drawn ones to stand in."""
        return Evidence(self.folder, None, (("KITTI-K0-2",), ("Street-Wide", "Street-Narrow")))

    def sweep(self, study: str, answers: Mapping[Cell, np.ndarray | int]) -> None:
        """A result table with its traces, from right answers or from how many of every ten are right."""
        table = ResultTable(self.folder, study)
        rows = []
        for cell, right in answers.items():
            trace_of(even(right) if isinstance(right, int) else right).save(table.trace_path(cell.id))
            where = {"cell": cell.id, "route": cell.route, "sampling_distance_m": cell.sampling_distance}
            rows.append({**where, "agent": cell.agent, "seed": cell.seed, "status": "ok"})
        pd.DataFrame(rows).reindex(columns=list(COLUMNS)).to_csv(table.csv, index=False)

    def fits(self, measures: Mapping[str, list[dict[str, float]]], route: str = "KITTI-K0-2") -> None:
        """fit.csv: the measures of each encoder, one table a seed."""
        rows = [
            {"encoder": encoder, "seed": seed, "route": route, **values}
            for encoder, seeds in measures.items()
            for seed, values in enumerate(seeds)
        ]
        pd.DataFrame(rows).to_csv(self.folder / "fit.csv", index=False)

    def timings(self, seconds: Mapping[str, list[float]], processor: str = "A CPU") -> None:
        """fit-timings.json: the seconds of each encoder, one number a seed."""
        fits = [
            {
                "encoder": encoder,
                "seed": str(seed),
                "route": "KITTI-K0-2",
                "seconds": {"fit_seconds": value, "s1_seconds": 0.1},
                "machine": {"processor": processor},
            }
            for encoder, seeds in seconds.items()
            for seed, value in enumerate(seeds)
        ]
        (self.folder / "fit-timings.json").write_text(json.dumps({"fits": fits}))

    def frequency(self, times: Mapping[str, Mapping[int, float]], spread: float = 0.0) -> None:
        """frequency.csv: median milliseconds by agent and places, the quartiles this share to both sides."""
        rows = [
            {
                "agent": agent,
                "places": places,
                "query_ms": ms,
                "query_ms_q1": ms * (1 - spread),
                "query_ms_q3": ms * (1 + spread),
            }
            for agent, curve in times.items()
            for places, ms in curve.items()
        ]
        pd.DataFrame(rows).to_csv(self.folder / "frequency.csv", index=False)


@pytest.fixture
def results(tmp_path: Path) -> Results:
    """An empty folder to write results into."""
    return Results(tmp_path)
