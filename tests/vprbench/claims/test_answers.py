"""Which roads, cells and tables a claim is judged on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from vprbench.claims.answers import find_answers
from vprbench.claims.reading import Untestable
from vprbench.sweep import Cell

if TYPE_CHECKING:
    from tests.vprbench.claims.conftest import Results

OWN = ("KITTI-K5-1", "KITTI-K5-2")
BOTH = ("hsd-15-30", "lpmp")


def cells(*routes: str, agents: tuple[str, ...] = ("HSD-15-30", "LPMP")) -> dict[Cell, int]:
    return {Cell(route, agent, 3.0, 0): 8 for route in routes for agent in agents}


@pytest.mark.parametrize(
    ("measured", "chosen", "words", "at_home"),
    [
        (["Street-Wide", "KITTI-K0-2", *OWN], OWN, "KITTI-K5-1, KITTI-K5-2", True),
        (["KITTI-K0-2", "KITTI-K5-2"], OWN[1:], "part of the routes: KITTI-K5-2", False),
        (["Street-Wide", "KITTI-K0-2"], ("KITTI-K0-2",), "stand-in: KITTI-K0-2", False),
        (["Elsewhere", "Street-Narrow"], ("Street-Narrow",), "stand-in: Street-Narrow", False),
    ],
)
def test_the_claims_own_roads_come_first(
    results: Results, measured: list[str], chosen: tuple[str, ...], words: str, at_home: bool
) -> None:
    results.sweep("global", cells(*measured))
    found = find_answers(results.evidence, "global", OWN, BOTH)
    assert {cell.route for cell in found.traces} == set(chosen)
    assert {cell.agent for cell in found.traces} == set(BOTH)
    assert (found.measured_on, found.at_home) == (words, at_home)


def test_a_spread_over_roads_takes_stand_ins_that_are_enough(results: Results) -> None:
    results.sweep("global", cells("KITTI-K0-2", "Street-Wide", "Street-Narrow"))
    found = find_answers(results.evidence, "global", OWN, BOTH, least=2)
    assert found.measured_on == "stand-in: Street-Wide, Street-Narrow"


def test_a_road_where_one_agent_is_missing_does_not_count(results: Results) -> None:
    results.sweep("global", {**cells("Street-Wide"), **cells("KITTI-K0-2", agents=("LPMP",))})
    assert find_answers(results.evidence, "global", OWN, BOTH).measured_on == "stand-in: Street-Wide"


def test_a_study_may_be_measured_in_parts(results: Results) -> None:
    results.sweep("global-k0-2", cells("KITTI-K0-2"))
    results.sweep("global-streets", cells("Street-Wide", "Street-Narrow"))
    assert find_answers(results.evidence, "global", OWN, BOTH).measured_on == "stand-in: KITTI-K0-2"
    assert len(find_answers(results.evidence, "global", OWN, BOTH, least=2).traces) == 4


def test_a_cell_that_stands_in_two_tables_is_taken_from_the_studys_own(results: Results) -> None:
    results.sweep("global", cells("KITTI-K0-2"))
    results.sweep("global-k0-2", dict.fromkeys(cells("KITTI-K0-2"), 3))
    found = find_answers(results.evidence, "global", OWN, BOTH)
    assert [trace.correct.mean() for trace in found.traces.values()] == [0.8, 0.8]


def test_what_is_missing_is_named(results: Results) -> None:
    with pytest.raises(Untestable, match=r"no global\.csv: vprbench sweep global makes it"):
        find_answers(results.evidence, "global", OWN, BOTH)
    results.sweep("global", cells("Elsewhere"))
    with pytest.raises(Untestable, match="KITTI-K5-1, KITTI-K5-2 not measured, nor 1 that could stand in"):
        find_answers(results.evidence, "global", OWN, BOTH)
    with pytest.raises(Untestable, match="global has no finished cell of cohog"):
        find_answers(results.evidence, "global", OWN, ("cohog", "lpmp"))
    with pytest.raises(Untestable, match="global has no finished cell of hsd-15-30 at 5 m"):
        find_answers(results.evidence, "global", OWN, BOTH, distances=[5.0])
