from __future__ import annotations

import numpy as np
import pymap3d
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.errors import DataError
from vprbench.geodesy import check_geodetic, compass_heading, course, local_positions, wrap

angles = st.floats(-1000.0, 1000.0)
latitudes, longitudes = st.floats(-80.0, 80.0), st.floats(-179.0, 179.0)
metres = st.floats(-1000.0, 1000.0)

# WGS 84: semi-major axis and squared eccentricity.
A, E2 = 6378137.0, 0.00669437999014


@given(angles)
def test_a_wrapped_angle_is_the_same_direction(angle: float) -> None:
    wrapped = wrap(np.array([angle]))[0]
    assert -np.pi <= wrapped <= np.pi
    assert (np.cos(wrapped), np.sin(wrapped)) == pytest.approx((np.cos(angle), np.sin(angle)), abs=1e-9)


def test_compass_headings_of_the_four_winds() -> None:
    yaw = np.array([0.0, np.pi / 2, -np.pi / 2])  # east, north, south
    assert compass_heading(yaw) == pytest.approx([np.pi / 2, 0.0, np.pi])
    assert compass_heading(np.array([3.1])) == pytest.approx([-3.1 + np.pi / 2])


@given(latitudes, longitudes, metres, metres)
def test_local_positions_undo_pymap3d(latitude: float, longitude: float, east: float, north: float) -> None:
    # The point of the ellipsoid under (east, north): a kilometre off, its height shortens the arc by 0.2 mm at most.
    far = np.array(pymap3d.enu2geodetic(east, north, 0.0, latitude, longitude, 0.0)[:2])
    found = local_positions(far[None], np.array([latitude, longitude]))[0]
    assert found == pytest.approx([east, north], abs=1e-3)


@given(st.floats(-70.0, 70.0), longitudes, st.floats(-0.001, 0.001), st.floats(-0.001, 0.001))
def test_local_positions_near_the_origin(latitude: float, longitude: float, up: float, right: float) -> None:
    phi = np.radians(latitude)
    bend = 1.0 - E2 * np.sin(phi) ** 2
    meridian, normal = A * (1.0 - E2) / bend**1.5, A / np.sqrt(bend)
    fixes = np.array([[latitude + up, longitude + right]])
    expected = [normal * np.cos(phi) * np.radians(right), meridian * np.radians(up)]
    assert local_positions(fixes, np.array([latitude, longitude]))[0] == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize(
    ("fix", "fault"),
    [
        ((95.0, 8.4), "latitude 95 is not within 90 degrees"),
        ((49.0, -200.0), "longitude -200 is not within 180 degrees"),
        ((49.0, np.nan), "longitude nan"),
    ],
)
def test_a_fix_off_the_globe_is_refused(fix: tuple[float, float], fault: str) -> None:
    with pytest.raises(DataError, match=f"row 1: {fault}"):
        check_geodetic(np.array([(49.0, 8.4), fix]), lambda row: f"row {row}")


def test_the_course_of_a_circle_is_its_tangent() -> None:
    bearing = np.linspace(0.0, 6.0, 601)
    circle = 50.0 * np.stack([np.sin(bearing), np.cos(bearing)], axis=1)  # clockwise from north
    tangent = wrap(bearing + np.pi / 2)
    assert np.abs(wrap(course(circle) - tangent))[10:-10].max() < 1e-6


def test_the_course_smooths_single_fixes() -> None:
    rng = np.random.default_rng(0)
    road = np.stack([np.zeros(100), np.arange(100.0)], axis=1) + rng.normal(0.0, 0.05, (100, 2))
    assert np.abs(course(road, window=5.0)).max() < 0.08


def test_a_standing_vehicle_keeps_its_course() -> None:
    east = np.concatenate([np.arange(10.0), np.full(20, 9.0), np.arange(10.0, 20.0)])
    assert course(np.stack([east, np.zeros(40)], axis=1)) == pytest.approx(np.full(40, np.pi / 2))
