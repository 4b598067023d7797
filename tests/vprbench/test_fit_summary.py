"""How fits are summed up on the terminal and in figures."""

from __future__ import annotations

from vprbench.cli.fit_figures import families
from vprbench.cli.fit_summary import fits_to_terminal
from vprbench.fit_table import Fit


def test_measures_of_one_family_share_an_axis() -> None:
    assert families(["s1_rate", "s1_rate_held_out", "s2_rate", "s1_map_rate", "size", "fit_seconds", "s1_seconds"]) == {
        "rate": ["s1_rate", "s1_rate_held_out", "s2_rate"],
        "map_rate": ["s1_map_rate"],
        "size": ["size"],
        "seconds": ["fit_seconds", "s1_seconds"],
    }


def test_a_single_fit_has_no_spread() -> None:
    table = fits_to_terminal([Fit({"encoder": "a", "seed": "0"}, {"rate": 0.123456}, {})])
    assert [str(cell) for cell in table.columns[1].cells] == ["0.1235"]
