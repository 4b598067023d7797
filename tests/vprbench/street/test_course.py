"""Courses and drives, against the geometry of curves."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vprbench.street.course import AHEAD, BEHIND, SPACING, build_course
from vprbench.street.drive import Drive, lane, plan_drive
from vprbench.street.parameters import Environment, StreetParameters

environments = st.sampled_from(["wide", "narrow", "mixed"])
seeds = st.integers(0, 10_000)


@settings(max_examples=25)
@given(environments, st.floats(20, 600), seeds)
def test_a_station_is_the_distance_along_the_course(environment: Environment, length: float, seed: int) -> None:
    course = build_course(environment, length, seed)
    steps = np.diff(course.centre, axis=0)
    # A chord is shorter than its arc by (k s)^2 / 24; no bend is tighter than 20 m.
    assert np.linalg.norm(steps, axis=1) == pytest.approx(SPACING, rel=(SPACING / 20) ** 2 / 24 + 1e-6)
    middle = (course.heading[1:] + course.heading[:-1]) / 2
    off = np.arctan2(steps[:, 0], steps[:, 1]) - middle
    assert np.abs((off + np.pi) % (2 * np.pi) - np.pi).max() < 1e-3
    assert course.world(np.zeros(1), np.zeros(1)) == pytest.approx(np.zeros((1, 2)), abs=1e-9)
    assert course.stations[0] == -BEHIND
    assert course.stations[-1] == pytest.approx(length + AHEAD, abs=SPACING)


@settings(max_examples=25)
@given(environments, seeds, st.floats(-20, 300), st.floats(-5, 5))
def test_lateral_is_the_distance_to_the_right(
    environment: Environment, seed: int, station: float, lateral: float
) -> None:
    course = build_course(environment, 200.0, seed)
    near = np.arange(station - 2.0, station + 2.0, 0.01)
    centre = course.world(near, np.zeros_like(near))
    away = np.linalg.norm(course.world(np.array([station]), np.array([lateral])) - centre, axis=1)
    assert away.min() == pytest.approx(abs(lateral), abs=0.01)
    ahead = course.heading_at(np.array(station))
    here, aside = course.world(np.array([station, station]), np.array([0.0, lateral]))
    right = (aside - here) @ np.array([np.cos(ahead), -np.sin(ahead)])
    assert right == pytest.approx(lateral, abs=1e-9)


def test_each_environment_has_its_bends_and_widths() -> None:
    for seed in range(8):
        wide, narrow, mixed = (build_course(e, 378.0, seed) for e in ("wide", "narrow", "mixed"))
        assert (wide.narrowness == 0).all()
        assert (narrow.narrowness == 1).all()
        assert mixed.narrowness.min() == pytest.approx(0) and mixed.narrowness.max() == pytest.approx(1)
        assert np.degrees(np.ptp(mixed.heading)) > 30
        assert np.degrees(np.abs(np.gradient(wide.heading, SPACING)).max()) < 0.5


@pytest.mark.parametrize("environment", ["wide", "narrow", "mixed"])
@pytest.mark.parametrize("offset", [0.0, 1.0, 4.0])
def test_the_second_drive_keeps_to_the_left_of_the_first(environment: Environment, offset: float) -> None:
    parameters = StreetParameters(environment, 150.0, lateral_offset=offset)
    course = build_course(environment, 150.0, 0)
    learn, test = (plan_drive(course, parameters, drive) for drive in ("learn", "test"))
    assert np.abs(learn.laterals - lane(course, learn.stations)).max() < 0.2
    assert np.abs(test.laterals - lane(course, test.stations) + offset).max() < 0.2


@settings(max_examples=25)
@given(environments, st.floats(20, 500), st.floats(0.3, 3.0), seeds, st.sampled_from(["learn", "test"]))
def test_a_drive_goes_the_whole_length_in_steps_of_its_own(
    environment: Environment, length: float, step: float, seed: int, drive: Drive
) -> None:
    parameters = StreetParameters(environment, length, seed, learn_step=step, test_step=step)
    motion = plan_drive(build_course(environment, length, seed), parameters, drive)
    assert motion.stations[0] == 0
    assert motion.stations[-1] == pytest.approx(length)
    steps = np.diff(motion.stations)
    # n steps are the whole number nearest to length / step, which is within half a step of it.
    assert steps.mean() == pytest.approx(step, rel=0.5 / len(steps) + 1e-9)
    assert 0.6 * steps.mean() < steps.min() and steps.max() < 1.4 * steps.mean()
    assert np.diff(motion.times) == pytest.approx(0.1)
    assert (np.abs(motion.headings) <= np.pi).all()
