"""Rates, times and sizes of fits made by hand, with SciPy for the intervals."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np
import pytest
from scipy import stats

from vprbench.claims.learning import LearningRatio, LearningTime, RateDifference, SignatureSize
from vprbench.claims.reading import Untestable
from vprbench.errors import DataError

if TYPE_CHECKING:
    from tests.vprbench.claims.conftest import Results

RATE = RateDifference(kind="rate-difference", encoder="hsd-30", reference="hsd-12", rate="s2_rate")
RATIO = LearningRatio(kind="learning-ratio", encoder="hsd-15-30", reference="hsd-30")


def rates(*values: float) -> list[dict[str, float]]:
    return [{"s2_rate": value, "signature_size": 225.0} for value in values]


def test_a_difference_of_rates_is_paired_by_seed(results: Results) -> None:
    small, large = [0.91, 0.94, 0.92], [0.80, 0.84, 0.83, 0.99]
    results.fits({"HSD-12": rates(*small), "hsd-30": rates(*large)})
    found = RATE.read(results.evidence, "fit", ["KITTI-K5-1"])
    steps = 100 * (np.array(large[:3]) - small)
    low, high = stats.t.interval(0.95, 2, steps.mean(), stats.sem(steps))
    assert (found.value, found.low, found.high) == pytest.approx((steps.mean(), low, high), abs=1e-4)
    assert found.measured_on == "stand-in: training frames of KITTI-K0-2; 3 seeds"
    assert not found.at_home


def test_of_one_seed_there_is_no_interval(results: Results) -> None:
    results.fits({"hsd-12": rates(0.9), "hsd-30": rates(0.8)}, route="KITTI-K5-1")
    found = RATE.read(results.evidence, "fit", ["KITTI-K5-1"])
    assert found.value == pytest.approx(-10.0)
    assert np.isnan([found.low, found.high]).all()
    assert found.at_home


def test_a_ratio_of_times_is_a_geometric_mean(results: Results) -> None:
    results.timings({"hsd-15-30": [2.0, 4.0], "hsd-30": [8.0, 4.0]})
    found = RATIO.read(results.evidence, "fit", ["KITTI-K5-1"])
    assert found.value == pytest.approx(0.5)
    assert found.low == pytest.approx(0.25 / found.high)
    assert found.measured_on.endswith("2 seeds; A CPU")
    time = LearningTime(kind="learning-time", encoder="hsd-30").read(results.evidence, "fit", [])
    assert (time.value, time.low) == pytest.approx((6.0, 6.0 - stats.t.ppf(0.975, 1) * 2.0), rel=1e-4)


def test_times_of_two_machines_are_not_compared(results: Results) -> None:
    results.timings({"hsd-15-30": [2.0]}, processor="One")
    one = json.loads((results.folder / "fit-timings.json").read_text())["fits"]
    results.timings({"hsd-30": [4.0]}, processor="Other")
    other = json.loads((results.folder / "fit-timings.json").read_text())["fits"]
    path = results.folder / "fit-timings.json"
    path.write_text(json.dumps({"fits": one + other}))
    with pytest.raises(Untestable, match="hsd-15-30 and hsd-30 were timed on two machines"):
        RATIO.read(results.evidence, "fit", [])
    path.write_text(json.dumps({"fits": one + [fit | {"encoder": "hsd-15-30", "seed": "1"} for fit in other]}))
    with pytest.raises(Untestable, match="times hsd-15-30 on several machines"):
        RATIO.read(results.evidence, "fit", [])


def test_sizes(results: Results) -> None:
    results.fits({"hsd-30": rates(0.8, 0.8)})
    size = SignatureSize(kind="signature-size", encoder="hsd-30").read(results.evidence, "fit", [])
    assert (size.value, size.low, size.high) == (225.0, 225.0, 225.0)


def test_the_size_of_what_needs_no_learning_is_measured(results: Results) -> None:
    size = SignatureSize(kind="signature-size", encoder="log-polar").read(results.evidence, "fit", [])
    assert (size.value, size.measured_on) == (2916.0, "an encoded frame")


def test_what_is_missing_is_named(results: Results) -> None:
    with pytest.raises(Untestable, match=r"no fit\.csv"):
        RATE.read(results.evidence, "fit", [])
    with pytest.raises(Untestable, match=r"no fit-timings\.json"):
        RATIO.read(results.evidence, "fit", [])
    results.fits({"hsd-30": [{"s1_rate": 0.5}]})
    results.timings({"hsd-30": [1.0]})
    with pytest.raises(Untestable, match=r"fit\.csv has no s2_rate of hsd-30"):
        RATE.read(results.evidence, "fit", [])
    with pytest.raises(Untestable, match=r"no timing of hsd-15-30"):
        RATIO.read(results.evidence, "fit", [])


@pytest.mark.parametrize("name", ["fit.csv", "fit-timings.json"])
def test_damaged_files_are_named(results: Results, name: str) -> None:
    (results.folder / name).write_text("{}")
    with pytest.raises(DataError, match=name):
        (RATE if name == "fit.csv" else RATIO).read(results.evidence, "fit", [])
