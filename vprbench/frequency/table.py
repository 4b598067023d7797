"""The table of frequencies: one row for each agent and number of places, medians over rounds between their quartiles.

frequency.csv   the rows
frequency.json  the machine they were taken on, and the rules
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from vprbench.atomic import replacing
from vprbench.errors import DataError
from vprbench.frequency.rounds import MOST_QUERIES, SLICE_SECONDS
from vprbench.frequency.stopwatch import Visit
from vprbench.frequency.subjects import Subject
from vprbench.machine import machine

__all__ = ["COLUMNS", "RULES", "as_table", "make_table_folder", "write_table"]

# Times of a query and of its parts, and its CPU time, ms: the median over rounds between the quartiles.
_PARTS = ("query", "encode", "respond")
_TIMES = tuple(f"{part}_ms{end}" for part in (*_PARTS, "query_cpu") for end in ("", "_q1", "_q3"))

COLUMNS = (
    "agent",
    "route",
    "places",
    "hz",
    *_TIMES,
    "cpu_per_wall",
    "parts_per_query",
    "rounds",
    "queries",
    "filled_from",
)

RULES = {
    "threads": "one, of linear algebra and of OpenCV; cpu_per_wall above 1 tells of others",
    "order": "each round visits every agent with every number of places once, in an order drawn anew",
    "warm-up": "one visit of each and one query before every visit, uncounted; frames are read before",
    "queries": f"of the test drive, a round's the same for all; a visit has as many as fit in {SLICE_SECONDS:g} s, "
    f"at least 1 and at most {MOST_QUERIES}; its time is their mean",
    "ms": "median over rounds by the clock on the wall, between the quartiles (_q1, _q3); cpu_ms likewise of CPU time",
    "hz": "1000 / query_ms",
    "encode": "the encoder's encode, called by itself; of a localizer without encoder, its describe",
    "respond": "respond with the landmarks at hand, timed by itself; without an encoder, query less encode",
    "parts_per_query": "(encode + respond) / query, the median over rounds, where the two were timed by themselves",
    "cpu_per_wall": "CPU time of all queries over their time by the clock on the wall",
    "filled_from": "frames of the learn drive in their order, then of the training and the test drives, then again "
    "from the first; those from elsewhere under the headings of the learn drive",
}


def as_table(route: str, subjects: Sequence[Subject], rounds: Sequence[Sequence[Visit]]) -> pd.DataFrame:
    """The rows of some finished rounds, each with a visit for every subject in their order."""
    by_subject = zip(subjects, zip(*rounds, strict=True), strict=True)
    rows = [{**_identity(route, subject), **_measured(visits)} for subject, visits in by_subject]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def write_table(table: pd.DataFrame, stamp: Mapping[str, Any], folder: Path) -> None:
    """Write FOLDER/frequency.csv and .json, the latter with the machine and what else there is to stamp."""
    written = json.dumps({**stamp, "machine": machine(), "rules": RULES}, indent=1) + "\n"
    with replacing(folder / "frequency.csv") as path:
        table.to_csv(path, index=False, lineterminator="\n", float_format="%.6g")
    with replacing(folder / "frequency.json") as path:
        path.write_text(written, "utf-8")


def make_table_folder(folder: Path) -> None:
    """Make the folder of the table, before anything is timed.

    Raises:
        DataError: that is not possible.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DataError(f"--out {folder}: cannot be written ({error.strerror}); choose another folder") from error


def _identity(route: str, subject: Subject) -> dict[str, Any]:
    return {
        "agent": subject.agent,
        "route": route,
        "places": subject.places,
        "filled_from": subject.filled_from,
    }


def _measured(visits: Sequence[Visit]) -> dict[str, float]:
    """The columns of one subject's visits."""
    query, encode, respond = (np.array([getattr(visit, part) for visit in visits]) for part in _PARTS)
    parts = np.median((encode + respond)[:, 0] / query[:, 0])
    if np.isnan(parts):
        respond = query - encode
    times: dict[str, float] = {}
    seconds = {"query": query[:, 0], "encode": encode[:, 0], "respond": respond[:, 0], "query_cpu": query[:, 1]}
    for part, laps in seconds.items():
        low, middle, high = np.percentile(1e3 * laps, [25, 50, 75])
        times |= {f"{part}_ms": middle, f"{part}_ms_q1": low, f"{part}_ms_q3": high}
    return times | {
        "hz": 1e3 / times["query_ms"],
        "cpu_per_wall": float(query[:, 1].sum() / query[:, 0].sum()),
        "parts_per_query": float(parts),
        "rounds": len(visits),
        "queries": sum(visit.queries for visit in visits),
    }
