"""Which agent is better, and how sure that is."""

from __future__ import annotations

import pandas as pd

from vprbench.errors import VprbenchError
from vprbench.figures.differences import paired_differences
from vprbench.figures.panels import distinct, plain
from vprbench.paired import compare
from vprbench.report.markup import fragment, paragraph
from vprbench.report.material import Material
from vprbench.report.section import Drawing, Section
from vprbench.sweep import Cell

__all__ = ["differences"]

TITLE = "Which agent is better?"
METRICS = {"auc_all": "AUC over all queries", "accuracy": "top-1 accuracy"}


def differences(material: Material) -> Section | None:
    """Every pair of agents on the queries that both answered; nothing where there is but one agent."""
    if len(distinct(run.agent for run in material.runs)) < 2:
        return None
    traces = {Cell(run.route, run.agent, run.distance, run.seed): run.trace for run in material.runs}
    try:
        frames = {metric: compare(traces, metric) for metric in METRICS}
    except VprbenchError as error:
        return Section(TITLE, paragraph(f"Left out: {error}."))
    tables = [{"title": METRICS[metric], "rows": _rows(frame)} for metric, frame in frames.items()]
    drawings = tuple(_drawing(metric, frame) for metric, frame in frames.items())
    return Section(TITLE, fragment("differences", tables=tables), figures=drawings)


def _drawing(metric: str, frame: pd.DataFrame) -> Drawing:
    """The comparisons by one metric as dots and intervals."""
    named = frame.assign(agent=frame["agent"].map(plain), reference=frame["reference"].map(plain))
    said = "; ".join(f"{row['pair']}: {row['difference']}, {row['verdict']}" for row in _rows(frame))
    caption = f"Differences in {METRICS[metric]}, as in the table."
    return Drawing(f"differences-{metric}", paired_differences(named), f"{caption} {said}", caption)


def _rows(frame: pd.DataFrame) -> list[dict[str, str]]:
    """The comparisons as text, differences in percentage points."""
    return [
        {
            "pair": f"{row['agent']} less {row['reference']}",
            "difference": _points(row["difference"]),
            "interval": "" if pd.isna(row["low"]) else f"{_points(row['low'])} to {_points(row['high'])}",
            "cells": str(row["cells"]),
            "queries": str(row["queries"]),
            "verdict": str(row["verdict"]),
        }
        for row in frame.to_dict("records")
    ]


def _points(share: float) -> str:
    """A signed number of percentage points."""
    return f"{share * 100:+.1f}".replace("-", "−")  # noqa: RUF001 - a minus, as wide as the plus
