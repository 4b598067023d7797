"""Shadows in a straight street, against their lengths worked by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.street.course import Course
from vprbench.street.pixels import no_pixels
from vprbench.street.sunlight import Outline, Sunlight, illuminate, shade_stations, sun_over

WALL, HEIGHT = 6.0, 8.0
FROM, TO = 20.0, 60.0  # stations between which houses stand on the right


def sun(course: Course, azimuth: float, elevation: float, *, crown: tuple[float, float] = (1.0, 0.0)) -> Sunlight:
    """Houses on the right, 6 m away and 8 m high, and a row of trees 4 m away where a crown is given."""
    stations = shade_stations(course)
    houses = np.zeros((2, len(stations)))
    houses[1, (stations > FROM) & (stations < TO)] = HEIGHT
    full = np.ones_like(houses)
    outline = Outline(wall=WALL * full, crown=4 * full, height=houses, low=crown[0] * full, high=crown[1] * full)
    return sun_over(course, outline, azimuth, elevation, np.ones((64, 64)))


def lit(sunlight: Sunlight, station: float, lateral: float, height: float) -> float:
    """Share of the sun's light that reaches one point."""
    pixels = no_pixels()
    pixels.station[0], pixels.lateral[0], pixels.up[0] = station, lateral, height
    illuminate(sunlight, pixels, 1)
    return float(pixels.light[0])


@given(st.floats(0.5, 1.2), st.floats(-5.0, 5.0))
def test_a_house_throws_its_shadow_as_far_as_the_sun_is_low(straight: Course, elevation: float, lateral: float) -> None:
    east = sun(straight, np.pi / 2, elevation)
    reach = HEIGHT / np.tan(elevation)
    gap = WALL - lateral - reach
    if abs(gap) > 0.3:
        assert lit(east, 40.0, lateral, 0.0) == float(gap > 0)


@given(st.floats(0.3, 2.8), st.floats(-3.0, 3.0), st.floats(0.0, 3.0))
def test_the_shadow_falls_away_from_the_sun(straight: Course, azimuth: float, lateral: float, height: float) -> None:
    low = sun(straight, azimuth, 0.2)
    slide = (WALL - lateral) / np.tan(azimuth)  # metres along the street from here to where the ray meets the row
    over = height + (WALL - lateral) / np.sin(azimuth) * np.tan(0.2)
    inside = FROM < 40.0 + slide < TO and over < HEIGHT
    if min(abs(40.0 + slide - FROM), abs(40.0 + slide - TO), abs(over - HEIGHT)) > 0.3:
        assert lit(low, 40.0, lateral, height) == float(not inside)


def test_no_shadow_falls_from_the_side_without_houses_or_behind_them(straight: Course) -> None:
    assert lit(sun(straight, -np.pi / 2, 0.2), 40.0, 0.0, 0.0) == 1.0
    assert lit(sun(straight, np.pi / 2, 0.2), 40.0, 7.0, 0.0) == 1.0
    assert lit(sun(straight, np.pi / 2, 0.2), 10.0, 0.0, 0.0) == 1.0


def test_a_crown_shades_between_its_ends_only(straight: Course) -> None:
    trees = sun(straight, np.pi / 2, np.pi / 4, crown=(2.0, 5.0))
    # Where houses stand no more, a ray at 45 degrees from lateral l meets the crowns at height 4 - l.
    assert [lit(trees, 100.0, 4.0 - up, 0.0) for up in (1.0, 3.5, 6.0)] == [1.0, 0.0, 1.0]


def test_the_sun_stands_where_it_should(straight: Course) -> None:
    toward = sun(straight, np.pi / 2, np.pi / 6).toward
    assert toward == pytest.approx([np.sqrt(3) / 2, 0.0, 0.5])
