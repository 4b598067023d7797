"""Frequencies, ratios and crossings of times made by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from vprbench.claims.reading import Untestable
from vprbench.claims.speed import Crossing, Frequency, FrequencyRatio
from vprbench.errors import DataError

if TYPE_CHECKING:
    from tests.vprbench.claims.conftest import Results

PLACES = (1, 10, 50, 100)
RATIO = FrequencyRatio(kind="frequency-ratio", agent="hsd-18", reference="lpmp", places=100)
CROSSING = Crossing(kind="crossing", agent="hsd-18", reference="lpmp")


def test_a_ratio_of_frequencies_is_that_of_times_turned(results: Results) -> None:
    results.frequency({"HSD-18": {100: 5.0}, "LPMP": {100: 10.0}}, spread=0.1)
    found = RATIO.read(results.evidence, "frequency", [])
    assert (found.value, found.low, found.high) == pytest.approx((2.0, 9.0 / 5.5, 11.0 / 4.5))
    assert found.remark == "200.0 Hz and 100.0 Hz"
    single = Frequency(kind="frequency", agent="lpmp", places=100).read(results.evidence, "frequency", [])
    assert (single.value, single.low, single.high) == pytest.approx((100.0, 1000 / 11.0, 1000 / 9.0))


def line(start: float, slope: float) -> dict[int, float]:
    return {places: start + slope * places for places in PLACES}


def test_two_lines_cross_where_they_are_equal(results: Results) -> None:
    """4 + 0.02 n = 1 + 0.14 n at n = 25; with each time a tenth off, at 3.5 and 47."""
    backwards = dict(reversed(line(4.0, 0.02).items()))
    results.frequency({"hsd-18": backwards, "lpmp": line(1.0, 0.14)}, spread=0.1)
    found = CROSSING.read(results.evidence, "frequency", [])
    low, high = ((4.0 * a - 1.0 * b) / (0.14 * b - 0.02 * a) for a, b in ((0.9, 1.1), (1.1, 0.9)))
    assert (found.value, found.low, found.high) == pytest.approx((25.0, low, high))


def test_what_never_crosses(results: Results) -> None:
    results.frequency({"hsd-18": line(1.0, 0.1), "lpmp": line(2.0, 0.1)})
    assert CROSSING.read(results.evidence, "frequency", []).value == 0.0
    results.frequency({"hsd-18": line(2.0, 0.1), "lpmp": line(1.0, 0.1)})
    assert CROSSING.read(results.evidence, "frequency", []).value == float("inf")


def test_what_is_missing_is_named(results: Results) -> None:
    with pytest.raises(Untestable, match=r"no frequency\.csv"):
        RATIO.read(results.evidence, "frequency", [])
    results.frequency({"hsd-18": {50: 1.0}, "lpmp": {10: 1.0}})
    with pytest.raises(Untestable, match="not measured with 100 places"):
        RATIO.read(results.evidence, "frequency", [])
    with pytest.raises(Untestable, match="no number of places that hsd-18 and lpmp share"):
        CROSSING.read(results.evidence, "frequency", [])
    with pytest.raises(Untestable, match="no row of cohog"):
        RATIO.model_copy(update={"reference": "cohog", "places": 50}).read(results.evidence, "frequency", [])


def test_a_damaged_table_is_named(results: Results) -> None:
    (results.folder / "frequency.csv").write_text("agent,places\nhsd-18,100\n")
    with pytest.raises(DataError, match=r"frequency\.csv: not readable as a table of frequencies"):
        RATIO.read(results.evidence, "frequency", [])


def test_two_rows_of_one_agent_and_number_of_places_are_refused(results: Results) -> None:
    results.frequency({"hsd-18": {100: 5.0}, "HSD-18": {100: 6.0}, "lpmp": {100: 10.0}})
    with pytest.raises(DataError, match="hsd-18 stands there twice with the same number of places"):
        RATIO.read(results.evidence, "frequency", [])
