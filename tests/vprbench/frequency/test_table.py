"""Medians, quartiles and crossings of times made by hand."""

from __future__ import annotations

import json
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from vprbench.errors import DataError
from vprbench.frequency.crossing import cheaper_from
from vprbench.frequency.stopwatch import UNTIMED, Lap, Visit
from vprbench.frequency.subjects import Subject
from vprbench.frequency.table import COLUMNS, as_table, make_table_folder, write_table

LOCALIZER: Any = None
APART = Subject("HSD", 10, "learn 10", LOCALIZER, LOCALIZER)
WHOLE = Subject("CoHOG", 10, "learn 8, test 2", LOCALIZER, None)


def row(subject: Subject, visits: list[Visit]) -> Any:  # noqa: ANN401
    (found,) = as_table("Road", [subject], [[one] for one in visits]).to_dict("records")
    return found


def test_medians_stand_between_quartiles() -> None:
    times = [0.004, 0.001, 0.003, 0.002, 0.010]
    found = row(APART, [Visit(Lap(t, t / 2), Lap(t / 4, 0), Lap(t / 2, 0), 3) for t in times])
    assert (found["agent"], found["route"], found["places"], found["filled_from"]) == ("HSD", "Road", 10, "learn 10")
    assert [found[f"query_ms{end}"] for end in ("_q1", "", "_q3")] == pytest.approx([2, 3, 4])
    assert [found[f"encode_ms{end}"] for end in ("_q1", "", "_q3")] == pytest.approx([0.5, 0.75, 1])
    assert [found[f"respond_ms{end}"] for end in ("_q1", "", "_q3")] == pytest.approx([1, 1.5, 2])
    assert [found[f"query_cpu_ms{end}"] for end in ("_q1", "", "_q3")] == pytest.approx([1, 1.5, 2])
    assert found["hz"] == pytest.approx(1000 / 3)
    assert (found["cpu_per_wall"], found["parts_per_query"]) == (pytest.approx(0.5), pytest.approx(0.75))
    assert (found["rounds"], found["queries"]) == (5, 15)


def test_without_an_encoder_the_rest_is_what_describing_leaves() -> None:
    visits = [Visit(Lap(t, t), Lap(0.001, 0.001), UNTIMED, 1) for t in (0.003, 0.005, 0.004)]
    found = row(WHOLE, visits)
    assert (found["encode_ms"], found["respond_ms"], found["respond_ms_q3"]) == pytest.approx((1, 3, 3.5))
    assert np.isnan(found["parts_per_query"])
    opaque = row(WHOLE, [Visit(Lap(0.003, 0.003), UNTIMED, UNTIMED, 1)])
    assert np.isnan([opaque["encode_ms"], opaque["respond_ms"]]).all()
    assert opaque["query_ms"] == pytest.approx(3)


def test_rows_are_in_the_order_of_the_subjects() -> None:
    quick, slow = (Visit(Lap(t, t), UNTIMED, UNTIMED, 1) for t in (0.001, 0.1))
    table = as_table("Road", [WHOLE, APART], [[slow, quick], [slow, quick]])
    assert list(table["agent"]) == ["CoHOG", "HSD"]
    assert list(table["query_ms"]) == pytest.approx([100, 1])
    assert tuple(table.columns) == COLUMNS


def test_the_table_and_its_machine_are_written(tmp_path: Path) -> None:
    table = as_table("Road", [APART], [[Visit(Lap(1 / 3, 1 / 3), Lap(0.1, 0.1), Lap(0.2, 0.2), 1)]])
    write_table(table, {"seed": 3}, tmp_path)
    assert "HSD,Road,10,3,333.333," in (tmp_path / "frequency.csv").read_text()
    stamp = json.loads((tmp_path / "frequency.json").read_text())
    assert stamp["seed"] == 3
    assert {"processor", "cores", "python", "libraries"} <= stamp["machine"].keys()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["frequency.csv", "frequency.json"]


def test_a_folder_that_cannot_be_made_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(DataError, match=r"--out .*file: cannot be written .*choose another folder"):
        make_table_folder(tmp_path / "file")


def times(**agents: dict[int, float]) -> pd.DataFrame:
    rows = [(agent, n, ms) for agent, found in agents.items() for n, ms in found.items()]
    return pd.DataFrame(rows, columns=["agent", "places", "query_ms"])


@pytest.mark.parametrize(
    ("mine", "start"),
    [
        ({1: 2.0, 10: 2.0, 20: 2.0}, 10.0),
        ({1: 2.5, 10: 2.5, 20: 2.5}, 15.0),
        ({1: 0.5, 10: 2.5, 20: 2.5}, 15.0),
        ({1: 0.5, 10: 1.0, 20: 2.5}, 0.0),
        ({1: 0.5, 10: 1.0, 20: 3.5}, inf),
        ({2: 0.5}, inf),
        ({20: 2.0, 10: 2.5, 1: 3.0}, 10 + 10 * 0.5 / 1.5),
    ],
)
def test_where_an_agent_becomes_cheaper(mine: dict[int, float], start: float) -> None:
    # The reference takes 1.1, 2 and 3 ms.
    table = times(ours=mine, LPMP={1: 1.1, 10: 2.0, 20: 3.0})
    assert cheaper_from(table, "ours", "LPMP") == pytest.approx(start)
