"""The table of scale: one row for each agent and number of places.

scale.csv   the rows
scale.json  the machine they were taken on, and the rules
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from vprbench.atomic import replacing
from vprbench.machine import machine
from vprbench.scale.city import SPACING
from vprbench.scale.growth import LEARNED, Size

__all__ = ["COLUMNS", "RULES", "scale_table", "write_scale"]

COLUMNS = (
    "agent",
    "route",
    "places",
    "query_ms",
    "query_ms_q1",
    "query_ms_q3",
    "query_cpu_ms",
    "encode_ms",
    "respond_ms",
    "respond_ms_q1",
    "respond_ms_q3",
    "bytes_per_place",
    "add_ms",
    "learn_ms",
    "queries",
    "stopped",
)

RULES = {
    "threads": "one, of linear algebra and of OpenCV",
    "places": f"{SPACING:g} m apart along a road that turns by 90 degrees at corners; each landmark has the signature "
    "of a real one, drawn from all of the route's; without an encoder, a frame is the left of one, the right of "
    "another",
    "queries": "frames of the test drive, each under the heading of a place drawn by chance; each is asked once "
    "before, uncounted",
    "ms": "by the clock on the wall; query and respond are medians over queries between the quartiles (_q1, _q3); "
    "query_cpu likewise of CPU time: where it is far below, others had the processor",
    "encode": "the encoder's encode, called by itself; of a localizer without encoder, its describe",
    "respond": "respond with the landmarks at hand; without an encoder, query less encode",
    "bytes_per_place": "of all that the localizer holds more than without places, with what arrays keep free",
    "add_ms": "a place, its landmarks at hand: store, where the localizer has it, else learn; mean since the last "
    "size; one goes before, uncounted",
    "learn_ms": f"learn, which asks all places first where a vigilance decides: median of the size's last {LEARNED}",
    "stopped": "what ended the curve before this size, by what the last one took",
}


def scale_table(route: str, grown: Mapping[str, Sequence[Size]]) -> pd.DataFrame:
    """The rows of each agent's sizes."""
    rows = [_row(agent, route, size) for agent, sizes in grown.items() for size in sizes]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def write_scale(table: pd.DataFrame, stamp: Mapping[str, Any], folder: Path) -> None:
    """Write FOLDER/scale.csv and .json, the latter with the machine and what else there is to stamp."""
    written = json.dumps({**stamp, "machine": machine(), "rules": RULES}, indent=1) + "\n"
    with replacing(folder / "scale.csv") as path:
        table.to_csv(path, index=False, lineterminator="\n", float_format="%.6g")
    with replacing(folder / "scale.json") as path:
        path.write_text(written, "utf-8")


def _row(agent: str, route: str, size: Size) -> dict[str, Any]:
    identity = {"agent": agent, "route": route, "places": size.places, "stopped": size.stopped}
    if not size.visits:
        return identity
    query, encode, respond = (
        1e3 * np.array([getattr(visit, part).wall for visit in size.visits]) for part in ("query", "encode", "respond")
    )
    if np.isnan(respond).any():
        respond = query - encode
    times: dict[str, float] = {}
    for part, found in (("query", query), ("respond", respond)):
        low, middle, high = np.percentile(found, [25, 50, 75])
        times |= {f"{part}_ms": middle, f"{part}_ms_q1": low, f"{part}_ms_q3": high}
    return {
        **identity,
        **times,
        "query_cpu_ms": 1e3 * np.median([visit.query.cpu for visit in size.visits]),
        "encode_ms": np.median(encode),
        "bytes_per_place": size.held / size.places,
        "add_ms": 1e3 * size.added,
        "learn_ms": 1e3 * np.median([laps.wall for laps in size.learned]),
        "queries": len(size.visits),
    }
