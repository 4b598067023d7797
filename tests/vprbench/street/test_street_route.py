"""Street routes: the same bytes always, two drives that differ, and a difficulty that can be set."""

from __future__ import annotations

import pickle
import subprocess
import sys
from dataclasses import replace
from hashlib import sha256
from typing import Any

import cv2
import numpy as np
import pytest

from vprbench.geodesy import local_positions
from vprbench.route import Route, Traverse
from vprbench.street import Environment, StreetParameters, street_route
from vprbench.types import Frame

PARAMETERS = StreetParameters("mixed", 60.0, seed=3)

# One frame of the first edition, averaged over 8 x 4 blocks.
EDITION_1 = [
    [99, 108, 95, 241, 233, 105, 82, 67],
    [57, 67, 92, 134, 114, 106, 100, 95],
    [49, 52, 80, 81, 63, 89, 108, 98],
    [72, 78, 71, 78, 77, 82, 100, 107],
]


@pytest.fixture(scope="module")
def route() -> Route:
    return street_route(PARAMETERS, name="Street-Mixed")


def digest(frame: Frame) -> str:
    return sha256(frame.tobytes()).hexdigest()


def test_frames_are_grey_pictures_of_the_agreed_size(route: Route) -> None:
    for traverse in (route.learn, route.test, *route.training):
        frame = traverse.frames[len(traverse) - 1]
        assert frame.shape == (188, 642)
        assert frame.dtype == np.uint8
        assert 30 < frame.mean() < 220 and frame.std() > 25
    with pytest.raises(IndexError):
        route.learn.frames[len(route.learn)]


def test_a_frame_does_not_depend_on_what_was_drawn_before(route: Route) -> None:
    order = [7, 0, 31, 7, 12]
    first = {i: digest(route.test.frames[i]) for i in order}
    again = street_route(PARAMETERS, name="again")
    assert {i: digest(again.test.frames[i]) for i in reversed(order)} == first


def test_another_process_draws_the_same_bytes(route: Route) -> None:
    program = (
        "import sys, pickle, hashlib\n"
        "route = pickle.loads(bytes.fromhex(sys.stdin.read()))\n"
        "print(*(hashlib.sha256(d.frames[9].tobytes()).hexdigest() for d in (route.test, route.learn)))"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program], input=pickle.dumps(route).hex(), capture_output=True, text=True, check=True
    )
    assert ran.stdout.split() == [digest(route.test.frames[9]), digest(route.learn.frames[9])]


def test_a_frame_is_the_callers_own(route: Route) -> None:
    before = digest(route.learn.frames[4])
    route.learn.frames[4][:] = 0
    assert digest(route.learn.frames[4]) == before


LENGTHS: dict[Environment, float] = {"wide": 96.0, "narrow": 199.0, "mixed": 378.0}


@pytest.mark.parametrize("environment", LENGTHS)
def test_drives_have_the_length_of_their_street(environment: Environment) -> None:
    parameters = StreetParameters(environment, LENGTHS[environment])
    drawn = street_route(parameters, name=environment)
    for traverse, step in ((drawn.learn, parameters.learn_step), (drawn.test, parameters.test_step)):
        # Wandering in the lane and keeping to one side of a bend change it a little.
        assert traverse.length == pytest.approx(parameters.length, rel=0.03)
        assert len(traverse) == round(parameters.length / step) + 1
    assert drawn.training[0].length == pytest.approx(100.0, rel=0.03)


def test_headings_point_where_the_vehicle_goes(route: Route) -> None:
    for traverse in (route.learn, route.test):
        steps = np.diff(traverse.positions, axis=0)
        off = np.arctan2(steps[:, 0], steps[:, 1]) - traverse.headings[:-1]
        assert np.degrees(np.abs(np.angle(np.exp(1j * off)))).max() < 5


def test_latitude_and_longitude_say_the_same_as_the_positions(route: Route) -> None:
    assert route.learn.geodetic is not None
    assert local_positions(route.learn.geodetic, np.zeros(2)) == pytest.approx(route.learn.positions, abs=1e-3)


def test_training_is_a_drive_through_another_street(route: Route) -> None:
    elsewhere = route.training[0].frames[5]
    assert all(np.abs(elsewhere.astype(float) - route.learn.frames[i]).mean() > 20 for i in range(0, 60, 10))


@pytest.mark.parametrize(
    "changes",
    [
        {"lateral_offset": 2.0},
        {"exposure": -1.0},
        {"occluders": 1.0},
        {"sun_shift": 120.0},
        {"noise": 20.0},
        {"test_step": 2.0},
    ],
)
def test_difficulty_changes_the_second_drive_alone_and_its_checksum(route: Route, changes: dict[str, Any]) -> None:
    harder = street_route(replace(PARAMETERS, **changes), name="harder")
    assert harder.test.checksum != route.test.checksum
    assert not np.array_equal(harder.test.frames[8], route.test.frames[8])
    assert harder.learn.checksum == route.learn.checksum
    assert np.array_equal(harder.learn.frames[8], route.learn.frames[8])


def test_without_any_difficulty_both_drives_see_the_same_street() -> None:
    calm = StreetParameters("narrow", 40.0, lateral_offset=0.0, exposure=0.0, occluders=0.0, sun_shift=0.0, noise=0.0)
    same, hard = (street_route(p, name="calm") for p in (calm, StreetParameters("narrow", 40.0)))
    apart = [np.abs(r.learn.frames[0].astype(float) - r.test.frames[0]).mean() for r in (same, hard)]
    assert apart[0] < 0.6 * apart[1]


def thumbnail(frame: Frame) -> np.ndarray:
    small = cv2.resize(frame, (64, 19), interpolation=cv2.INTER_AREA).astype(np.float64)
    return np.asarray((small - small.mean()) / small.std())


def recognised(learn: Traverse, test: Traverse) -> float:
    """Share of test frames whose most alike learn frame, of every third, is among the two nearest."""
    places = np.arange(0, len(learn), 3)
    memory = np.stack([thumbnail(learn.frames[int(i)]) for i in places])
    queries = np.stack([thumbnail(test.frames[i]) for i in range(0, len(test), 2)])
    best = np.abs(queries[:, None] - memory[None]).mean(axis=(2, 3)).argmin(axis=1)
    away = np.linalg.norm(test.positions[::2, None] - learn.positions[None, places], axis=2)
    return float((away.argsort(axis=1)[:, :2] == best[:, None]).any(axis=1).mean())


def test_the_street_is_neither_trivial_nor_hopeless_and_harder_farther_aside() -> None:
    parameters = StreetParameters("wide", 96.0)
    shares = []
    for offset in (parameters.lateral_offset, 3.0):
        drawn = street_route(replace(parameters, lateral_offset=offset), name="aside")
        shares.append(recognised(drawn.learn, drawn.test))
    assert 0.5 < shares[0] <= 1.0
    assert shares[1] < shares[0] - 0.2


def test_a_new_picture_is_a_new_edition() -> None:
    """Where this fails, the drawing has changed: count `_EDITION` up in vprbench.street, so that checksums do."""
    frame = street_route(StreetParameters("mixed", 60.0), name="edition").test.frames[20]
    assert np.abs(cv2.resize(frame, (8, 4), interpolation=cv2.INTER_AREA).astype(int) - EDITION_1).max() <= 2
