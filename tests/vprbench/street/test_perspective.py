"""Where things land in the picture, against the pinhole equations worked by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from vprbench.street.canvas import Canvas, View
from vprbench.street.course import Course
from vprbench.street.ground import GROUND_HALF, GROUND_ROAD, paint_ground
from vprbench.street.mesh import BILLBOARD, BOX, CAR, DECAL, FLAT_HOUSE, GABLED_HOUSE, MESHES
from vprbench.street.raster import nearest_first, paint_things
from vprbench.street.sunlight import Sunlight
from vprbench.street.texture import Skins, stack_skins
from vprbench.street.things import Thing, place

FX, FY, CX, CY, EYE = 372.0, 360.0, 314.0, 92.6, 1.65


def view(east: float = 0.0, north: float = 0.0, heading: float = 0.0) -> View:
    return View(642, 188, FX, FY, CX, CY, east, north, EYE, np.cos(heading), np.sin(heading), station=north)


@pytest.fixture(scope="module")
def painter(straight: Course, open_sky: Sunlight, white: Skins) -> "Painter":
    return Painter(straight, open_sky, white)


class Painter:
    """Paints white things, and nothing else, in the straight street."""

    def __init__(self, course: Course, sunlight: Sunlight, white: Skins) -> None:
        self.course, self.sunlight = course, sunlight
        self.skins = Skins(white.texels, np.repeat(white.table, 8, axis=0))

    def __call__(self, camera: View, *things: Thing) -> Canvas:
        canvas = Canvas.blank(camera.height, camera.width)
        ordered = nearest_first(camera, place(self.course, things))
        paint_things(canvas, camera, ordered, MESHES, self.skins, self.sunlight)
        return canvas


def extent(covered: np.ndarray) -> tuple[float, float]:
    """First and last index at which something is seen."""
    seen = np.flatnonzero(covered)
    return float(seen[0]), float(seen[-1])


@given(
    st.floats(-8.0, 8.0),
    st.floats(6.0, 60.0),
    st.floats(-3.0, 3.0),
    st.floats(-5.0, 5.0),
    st.floats(-0.5, 0.5),
)
def test_a_pole_lands_at_its_column(
    painter: Painter, lateral: float, station: float, east: float, north: float, heading: float
) -> None:
    right = (lateral - east) * np.cos(heading) - (station - north) * np.sin(heading)
    ahead = (lateral - east) * np.sin(heading) + (station - north) * np.cos(heading)
    assume(ahead > 1.0)
    column, row = CX + FX * right / ahead, CY + FY * EYE / ahead
    assume(3 < column < 638 and row < 180)
    covered = (
        1 - painter(view(east, north, heading), Thing(BILLBOARD, 0, station, lateral, width=0.1, height=2.0)).clear
    )
    weight = covered.sum(axis=0)
    assert (weight @ np.arange(642)) / weight.sum() == pytest.approx(column, abs=1.0)
    top, foot = extent(covered.any(axis=1) & (covered.max(axis=1) > 0.5))
    assert foot == pytest.approx(row, abs=1.0)
    assert top == pytest.approx(max(CY + FY * (EYE - 2.0) / ahead, 0.0), abs=1.0)


@given(st.floats(8.0, 60.0), st.floats(-3.0, 3.0))
def test_a_mark_on_the_road_lands_at_its_row(painter: Painter, station: float, lateral: float) -> None:
    covered = 1 - painter(view(), Thing(DECAL, 0, station, lateral, length=2.0, width=1.0)).clear
    far, near = extent(covered.max(axis=1) > 0.5)
    assert far == pytest.approx(CY + FY * EYE / (station + 1.0), abs=1.0)
    assert near == pytest.approx(CY + FY * EYE / (station - 1.0), abs=1.0)


@given(st.floats(7.0, 40.0), st.floats(2.0, 6.0), st.sampled_from([-1.0, 1.0]))
def test_a_box_beside_the_road_shows_front_and_near_end(
    painter: Painter, station: float, lateral: float, side: float
) -> None:
    box = Thing(BOX, 0, station, side * lateral, length=4.0, width=2.0, height=1.0, forward=side)
    columns = extent((1 - painter(view(), box).clear).max(axis=0) > 0.5)
    inner, outer = CX + side * FX * lateral / (station + 2.0), CX + side * FX * (lateral + 2.0) / (station - 2.0)
    low, high = sorted(np.clip([inner, outer], 0, 641))
    assert columns[0] == pytest.approx(low, abs=1.0)
    assert columns[1] == pytest.approx(high, abs=1.0)


@pytest.mark.parametrize("mesh", [BOX, FLAT_HOUSE])
@pytest.mark.parametrize("heading", [-0.3, 0.0, 0.4])
def test_a_convex_solid_has_no_gaps_between_its_faces(painter: Painter, mesh: int, heading: float) -> None:
    solid = Thing(mesh, 0, 12.0, 1.0, length=5.0, width=3.0, height=2.0)
    covered = 1 - painter(view(heading=heading), solid).clear
    for column in covered[:, covered.max(axis=0) > 0.99].T:
        first, last = extent(column > 0.99)
        assert column[int(first) : int(last) + 1].min() > 0.98


@given(st.floats(5.0, 60.0), st.floats(-0.4, 0.4))
def test_light_is_shared_out_once(painter: Painter, station: float, heading: float) -> None:
    row = [Thing(GABLED_HOUSE, 0, station + 9 * i, 5.0, 9.0, 8.0, 6.0) for i in range(4)]
    cars = [Thing(CAR, 0, station + 6 * i, 2.0, 4.0, 1.7, 1.5) for i in range(5)]
    canvas = painter(view(heading=heading), *row, *cars)
    assert canvas.clear.min() > -1e-6
    assert canvas.clear.max() <= 1.0
    # White in the zenith's sun is the brightest there is.
    assert canvas.light.max() <= 1.0 + painter.sunlight.direct + 1e-5


def test_what_is_nearer_hides_what_is_behind(straight: Course, open_sky: Sunlight) -> None:
    images = [np.dstack([np.full((8, 8), luma), np.ones((8, 8))]).astype(np.float32) for luma in (0.2, 0.8)]
    skins = stack_skins(images)
    things = [Thing(BILLBOARD, skin, at, 0.0, width=2.0, height=3.0) for skin, at in ((0, 10.0), (1, 20.0))]
    pictures = []
    for order in (things, things[::-1]):
        canvas = Canvas.blank(188, 642)
        paint_things(canvas, view(), nearest_first(view(), place(straight, order)), MESHES, skins, open_sky)
        pictures.append(canvas.light)
    assert np.array_equal(pictures[0], pictures[1])
    middle = pictures[0][int(CY) - 10, int(CX)]
    assert middle == pytest.approx(0.2 * (0.75 + 0.6 * open_sky.direct), abs=0.01)


@pytest.mark.parametrize(("mesh", "first"), [(CAR, "solid"), (FLAT_HOUSE, "post")])
def test_a_car_hides_the_post_beside_it_and_a_house_does_not(straight: Course, mesh: int, first: str) -> None:
    solid = Thing(mesh, 0, 12.0, 3.0, length=4.0, width=1.8, height=1.5)
    post = Thing(BILLBOARD, 0, 13.0, 3.0 + (1.5 if mesh == CAR else -0.5), width=0.2, height=3.0)
    for things in ((solid, post), (post, solid)):
        nearest = nearest_first(view(), place(straight, things))[0]
        assert nearest["mesh"] == (mesh if first == "solid" else BILLBOARD)


def test_what_is_behind_the_camera_is_not_seen(painter: Painter) -> None:
    assert painter(view(north=30.0), Thing(BOX, 0, 20.0, 1.0, 4.0, 2.0, 2.0)).clear.min() == 1.0


@given(st.floats(-1.0, 1.0), st.floats(-0.2, 0.2))
def test_the_kerb_lies_where_the_road_ends(straight: Course, open_sky: Sunlight, east: float, heading: float) -> None:
    half = 5.0
    luma = np.zeros((512, 64), np.float32)
    luma[np.abs((np.arange(512) + 0.5) / 512 * 2 * GROUND_HALF - GROUND_HALF) < GROUND_ROAD] = 1.0
    skins = stack_skins([np.stack([luma, np.ones_like(luma)], axis=-1)])
    n = len(straight.heading)
    ground = np.column_stack([straight.centre, np.ones(n), np.zeros(n), np.full(n, half)])
    canvas, camera = Canvas.blank(188, 642), view(east, 20.0, heading)
    paint_ground(canvas, camera, ground, skins.texels, skins.table[0], open_sky)
    for row in (120, 150, 180):
        ahead = EYE * FY / (row - CY)
        for edge in (-half, half):
            # A point of the kerb on this row: right * cos + ahead * sin = edge - east.
            column = CX + FX * ((edge - east) / np.cos(heading) - ahead * np.tan(heading)) / ahead
            if 4 < column < 637:
                line = canvas.light[row] > canvas.light.max() / 2
                crossings = np.flatnonzero(np.diff(line.astype(int)))
                assert np.abs(crossings + 0.5 - column).min() < 1.5
