"""What lengths are in, from a row to a table's head; and tables that were kept before rows said it."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from vprbench.errors import DataError
from vprbench.results import read_table
from vprbench.tables import make_table, to_markdown

RESULTS = Path(__file__).parents[2] / "results"
ROWS = pd.DataFrame(
    {
        "cell": [f"{route}/{distance}m/A/s0" for route in ("R1", "R2") for distance in (2, 5)],
        "status": "ok",
        "agent": "A",
        "seed": 0,
        "route": ["R1", "R1", "R2", "R2"],
        "sampling_distance_m": [2.0, 5.0, 2.0, 5.0],
        "error_mean_m": [1.0, 2.0, 3.0, 4.0],
    }
)


@pytest.mark.parametrize(
    ("units", "said"),
    [
        ([], "m"),
        (["m"] * 4, "m"),
        (["frames"] * 4, "frames"),
        (["frames", "", "frames", "frames"], "frames"),
        (["m", "m", "frames", "frames"], "m or frames"),
    ],
)
def test_a_table_is_headed_by_the_unit_of_its_rows(units: list[str], said: str) -> None:
    table = make_table(ROWS.assign(unit=units) if units else ROWS, metric="error_mean_m")
    assert table.columns == (f"2 {said}", f"5 {said}", "mean")
    assert f"mean error, in {said}, by" in to_markdown(table)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_table_that_says_no_unit_is_in_metres(tmp_path: Path, suffix: str) -> None:
    old = tmp_path / f"old{suffix}"
    rows = read_table(RESULTS / f"k0-2{suffix}").drop(columns=["unit", "heading_source"])
    rows.to_csv(old, index=False) if suffix == ".csv" else rows.to_parquet(old)
    table = read_table(old)
    assert set(table["unit"]) == {"m"}
    assert set(table["heading_source"]) == {""}


def test_a_table_that_lacks_another_column_is_refused(tmp_path: Path) -> None:
    pd.read_csv(RESULTS / "k0-2.csv").drop(columns="queries").to_csv(tmp_path / "x.csv", index=False)
    with pytest.raises(DataError, match="it has no column 'queries'"):
        read_table(tmp_path / "x.csv")
