"""Differences, levels and spreads of AUC where each answer is as sure as the next: AUC is (1 + accuracy) / 2."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from vprbench.claims.accuracy import AucDifference, AucGrowth, AucLevel, SpreadRatio
from vprbench.claims.reading import Reading, Untestable
from vprbench.paired import compare
from vprbench.results import ResultTable
from vprbench.sweep import Cell

if TYPE_CHECKING:
    from tests.vprbench.claims.conftest import Results

K5, K5_2 = "KITTI-K5-1", "KITTI-K5-2"
DIFFERENCE = AucDifference(kind="auc-difference", agent="hsd-15-30", reference="lpmp")


def test_a_difference_in_points(results: Results) -> None:
    """8 and 5 right of ten: AUC 90 and 75; over all queries AUC times accuracy, 72 and 37.5."""
    results.sweep("auc-hsd", {Cell(K5, "HSD-15-30", 2.0, 0): 8, Cell(K5, "LPMP", 2.0, 0): 5})
    found = DIFFERENCE.read(results.evidence, "auc-hsd", [K5])
    assert (found.value, found.low, found.high) == pytest.approx((15.0, 15.0, 15.0))
    assert found.measured_on == "KITTI-K5-1; 1 cells, 200 queries, seeds 1 and 1"
    assert found.remark == "AUC over all queries +34.5 (+34.5 to +34.5); top-1 +30.0 (+30.0 to +30.0)"
    assert found.at_home


def test_the_interval_is_that_of_paired_differences(results: Results) -> None:
    rng = np.random.default_rng(2)
    results.sweep(
        "auc-hsd",
        {
            **{Cell(K5, "hsd-15-30", d, seed): rng.random(200) < 0.8 for d in (2.0, 5.0) for seed in range(3)},
            **{Cell(K5, "lpmp", d, 0): rng.random(200) < 0.7 for d in (2.0, 5.0)},
        },
    )
    pairs = compare(ResultTable(results.folder, "auc-hsd"), "auc", agents=["hsd-15-30"], reference="lpmp")
    found = DIFFERENCE.read(results.evidence, "auc-hsd", [K5])
    expected = 100 * pairs[["difference", "low", "high"]].to_numpy(float)[0]
    assert (found.value, found.low, found.high) == pytest.approx(tuple(expected))
    assert found.low < found.value < found.high
    assert "seeds 3 and 1" in found.measured_on


def test_a_difference_at_one_distance_only(results: Results) -> None:
    results.sweep(
        "global",
        {Cell(K5, a, d, 0): right for a, d, right in [("hsd-15-30", 2.0, 6), ("lpmp", 2.0, 6), ("hsd-15-30", 5.0, 9)]}
        | {Cell(K5, "lpmp", 5.0, 0): 5},
    )
    at_5 = DIFFERENCE.model_copy(update={"distances": (5.0,)})
    assert at_5.read(results.evidence, "global", [K5]).value == pytest.approx(20.0)
    assert DIFFERENCE.read(results.evidence, "global", [K5]).value == pytest.approx(10.0)
    growth = AucGrowth(kind="auc-growth", agent="hsd-15-30", reference="lpmp", distance=5, reference_distance=2)
    found = growth.read(results.evidence, "global", [K5])
    assert (found.value, found.low, found.high) == pytest.approx((20.0, 20.0, 20.0))


def test_a_level_is_the_mean_over_agents_and_cells(results: Results) -> None:
    results.sweep(
        "auc-hsd", {Cell(K5, f"hsd-{n}", d, 0): right for n, d, right in [(21, 2, 6), (24, 2, 7), (30, 2, 8)]}
    )
    found = AucLevel(kind="auc-level", agents=("hsd-21", "hsd-24", "hsd-30")).read(results.evidence, "auc-hsd", [K5])
    assert (found.value, found.low, found.high) == pytest.approx((85.0, 85.0, 85.0))


def test_the_interval_of_a_level_is_widened_as_that_of_a_difference(results: Results) -> None:
    """Beside an agent that is always right, a level is as unsure as its difference from 100."""
    right = np.random.default_rng(3).random(200) < 0.7
    results.sweep("auc-hsd", {Cell(K5, "lpmp", 2.0, 0): right, Cell(K5, "hsd-15-30", 2.0, 0): 10})
    level = AucLevel(kind="auc-level", agents=("lpmp",)).read(results.evidence, "auc-hsd", [K5])
    lead = DIFFERENCE.read(results.evidence, "auc-hsd", [K5])
    assert (100 - level.value, 100 - level.high, 100 - level.low) == pytest.approx((lead.value, lead.low, lead.high))
    assert level.low < level.high


def spread(results: Results, over: str) -> Reading:
    measure = SpreadRatio.model_validate(
        {"kind": "spread-ratio", "agent": "hsd-15-30", "reference": "lpmp", "over": over}
    )
    found = measure.read(results.evidence, "global", [K5, K5_2])
    assert found.low == pytest.approx(found.value) == found.high
    return found


def test_spreads_over_roads_and_over_distances(results: Results) -> None:
    """Means 6 and 7 against 4 and 8 of ten: deviations 1 to 4. Within a road 2 and 0 against 2 and 4: 1 to 3."""
    right = {
        "hsd-15-30": {(K5, 2.0): 5, (K5, 5.0): 7, (K5_2, 2.0): 7, (K5_2, 5.0): 7},
        "lpmp": {(K5, 2.0): 3, (K5, 5.0): 5, (K5_2, 2.0): 6, (K5_2, 5.0): 10},
    }
    results.sweep("global", {Cell(r, a, d, 0): k for a, places in right.items() for (r, d), k in places.items()})
    routes, distances = spread(results, "routes"), spread(results, "distances")
    assert (routes.value, distances.value) == pytest.approx((1 / 4, 1 / 3))
    assert routes.remark == "standard deviations 3.5 and 14.1 points"
    assert distances.remark == "standard deviations 3.5 and 10.6 points"


def test_one_distance_has_no_spread(results: Results) -> None:
    results.sweep("global", {Cell(r, a, 2.0, 0): 7 for r in (K5, K5_2) for a in ("hsd-15-30", "lpmp")})
    with pytest.raises(Untestable, match="but one of the distances"):
        spread(results, "distances")


def test_a_cell_that_one_agent_lacks_is_named(results: Results) -> None:
    results.sweep("global", {Cell(K5, "hsd-15-30", d, 0): 7 for d in (2.0, 5.0)} | {Cell(K5, "lpmp", 2.0, 0): 7})
    growth = AucGrowth(kind="auc-growth", agent="hsd-15-30", reference="lpmp", distance=5, reference_distance=2)
    with pytest.raises(Untestable, match=r"no finished cell .*K5-1.*5"):
        growth.read(results.evidence, "global", [K5])
