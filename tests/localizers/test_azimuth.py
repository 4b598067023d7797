from __future__ import annotations

from math import exp, inf, pi, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vprbench_localizers.azimuth import agreeing_pairs, agreement, azimuths

CAMERA = np.array([372.0, 314.0])
ANGLES = st.lists(st.floats(-pi, pi), max_size=12)


def columns(*values: float) -> np.ndarray:
    return np.array(values, np.float32)


def test_a_column_points_by_the_pinhole_model() -> None:
    theta = azimuths(columns(314, 314 + 372, 314 - 372, 314 + 372 * 3**0.5), 0.5, CAMERA)
    np.testing.assert_allclose(theta, [0.5, 0.5 + pi / 4, 0.5 - pi / 4, 0.5 + pi / 3], atol=1e-6)
    assert theta.dtype == np.float32


def test_an_azimuth_wraps_behind_the_vehicle() -> None:
    theta = azimuths(columns(314 + 372, 314 - 372), 3.0, CAMERA)
    np.testing.assert_allclose(theta, [3.0 + pi / 4 - 2 * pi, 3.0 - pi / 4], atol=1e-6)


def test_no_columns_have_no_azimuths() -> None:
    assert azimuths(columns(), 1.0, CAMERA).shape == (0,)


def agreements(query: float, units: np.ndarray, width: float) -> list[float]:
    return [float(agreement(np.float32(query), unit, width)) for unit in units]


def test_agreement_falls_as_a_gaussian_and_ends_at_the_reach() -> None:
    units = columns(*np.radians([0.0, 5.0, -10.0, 14.9, 15.1, -90.0]))
    p, m = agreeing_pairs(columns(0.0), units, radians(15))
    assert p.tolist() == [0, 0, 0, 0]
    assert m.tolist() == [0, 1, 2, 3]
    expected = [1.0, exp(-0.5), exp(-2.0), exp(-0.5 * 2.98**2)]
    np.testing.assert_allclose(agreements(0.0, units[m], radians(5)), expected, rtol=1e-5)


def test_azimuths_agree_across_the_seam_behind_the_vehicle() -> None:
    p, m = agreeing_pairs(columns(pi - 0.02), columns(0.02 - pi, 0.0), 0.12)
    assert (p.tolist(), m.tolist()) == ([0], [0])
    assert agreements(pi - 0.02, columns(0.02 - pi), 0.04) == pytest.approx([exp(-0.5)], rel=1e-4)


def test_an_infinite_width_lets_all_agree_fully() -> None:
    p, m = agreeing_pairs(columns(-3.0, 0.0, 3.0), columns(1.0, -1.0), inf)
    assert list(zip(m.tolist(), p.tolist(), strict=True)) == [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)]
    assert agreements(-3.0, columns(1.0, -1.0, 3.0), inf) == [1.0] * 3


def test_of_no_azimuths_none_agree() -> None:
    for queries, units in ((columns(), columns(0.0)), (columns(0.0), columns())):
        assert [len(index) for index in agreeing_pairs(queries, units, inf)] == [0, 0]


@settings(max_examples=60, deadline=None)
@given(queries=ANGLES, units=ANGLES, width=st.floats(0.01, 2.0), widths=st.floats(0.5, 4.0))
def test_pairs_equal_the_turn_between_unit_vectors(
    queries: list[float], units: list[float], width: float, widths: float
) -> None:
    reach = width * widths
    found = set(
        zip(*(index.tolist() for index in agreeing_pairs(columns(*queries), columns(*units), reach)), strict=True)
    )
    for p, query in enumerate(queries):
        for m, unit in enumerate(units):
            turn = abs(np.angle(np.exp(1j * (query - unit))))
            assert agreements(query, columns(unit), width) == pytest.approx([exp(-0.5 * (turn / width) ** 2)], abs=1e-3)
            if abs(turn - reach) > 1e-5:
                assert ((p, m) in found) == (turn < reach)
