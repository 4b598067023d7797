"""What the painter lays on the canvas, against pictures resampled by SciPy at places worked by hand."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from jaxtyping import Float64
from scipy.ndimage import map_coordinates

from vprbench.street.canvas import Canvas, View
from vprbench.street.course import Course
from vprbench.street.ground import GROUND_HALF, GROUND_PERIOD, GROUND_ROAD, paint_ground
from vprbench.street.mesh import BILLBOARD, MESHES
from vprbench.street.pixels import drop_unseen, no_pixels
from vprbench.street.raster import paint_things
from vprbench.street.sky import paint_sky
from vprbench.street.sunlight import Sunlight
from vprbench.street.texture import Skins, stack_skins
from vprbench.street.things import Thing, place

SIDE = 16
FX, FY, CX, CY, EYE = 372.0, 360.0, 314.0, 92.6, 1.65
Y, X = np.mgrid[0:188, 0:642].astype(np.float64)

Plane = Float64[np.ndarray, "height width"]


def view(east: float = 0.0, heading: float = 0.0) -> View:
    return View(642, 188, FX, FY, CX, CY, east, 20.0, EYE, np.cos(heading), np.sin(heading), station=20.0)


def noise(*, holes: bool) -> Skins:
    """Random texels, a quarter of them fully clear and a quarter opaque where there are holes."""
    rng = np.random.default_rng(0)
    alpha = np.clip(rng.uniform(-0.5, 1.5, (SIDE, SIDE)), 0.0, 1.0) if holes else np.ones((SIDE, SIDE))
    return stack_skins([np.stack([rng.random((SIDE, SIDE)) * alpha, alpha], axis=-1).astype(np.float32)])


def resampled(skins: Skins, u: Plane, v: Plane) -> tuple[Plane, Plane]:
    """Luma and alpha, 0..1, of the whole texture at (u, v)."""
    texels = skins.texels.reshape(2 * SIDE, 2 * SIDE)[:SIDE, :SIDE].astype(np.int64)
    at = np.array([v * SIDE - 0.5, u * SIDE - 0.5])
    luma, alpha = (map_coordinates(part / 255.0, at, order=1, mode="nearest") for part in (texels >> 8, texels & 255))
    return luma, alpha


@settings(max_examples=8)
@given(st.floats(2.0, 5.0), st.floats(-1.5, 1.5), st.floats(0.5, 1.0))
def test_a_near_picture_is_seen_texel_by_texel(
    straight: Course, open_sky: Sunlight, ahead: float, lateral: float, share: float
) -> None:
    # Two pictures, one right behind the other: light passes through the holes of the first.
    skins, canvas = noise(holes=True), Canvas.blank(188, 642)
    things = [Thing(BILLBOARD, 0, 20.0 + ahead * far, lateral, width=3.0, height=2.5, bright=share) for far in (1, 1.5)]
    paint_things(canvas, view(), place(straight, things), MESHES, skins, open_sky)
    light, clear, inside = np.zeros_like(X), np.ones_like(X), np.ones(X.shape, bool)
    for far in (ahead, 1.5 * ahead):
        right, up = (X - CX) / FX * far, EYE - (Y - CY) / FY * far
        u, v = (right - lateral) / 3.0 + 0.5, 1.0 - up / 2.5
        luma, alpha = resampled(skins, u, v)
        light, clear = light + clear * luma * share * (0.75 + 0.6 * open_sky.direct), clear * (1 - alpha)
        inside &= (np.abs(u - 0.5) < 0.5) & (np.abs(v - 0.5) < 0.5)
    assert inside.sum() > 2048  # more than one batch
    assert np.abs(canvas.light - light)[inside].max() < 0.01
    assert np.abs(canvas.clear - clear)[inside].max() < 0.005


@settings(max_examples=8)
@given(st.floats(-1.0, 1.0), st.floats(-0.1, 0.1))
def test_the_ground_shows_its_texture(straight: Course, open_sky: Sunlight, east: float, heading: float) -> None:
    n, camera, canvas, skins = len(straight.heading), view(east, heading), Canvas.blank(188, 642), noise(holes=False)
    canvas.clear[:, ::7] = 0.0  # where something stands before the ground
    course = np.column_stack([straight.centre, np.ones(n), np.zeros(n), np.full(n, GROUND_ROAD)])
    paint_ground(canvas, camera, course, skins.texels, skins.table[0], open_sky)
    with np.errstate(divide="ignore"):
        ahead = EYE * FY / (Y - CY)
    right = (X - CX) / FX * ahead
    lateral = east + ahead * camera.sin + right * camera.cos
    station = 20.0 + ahead * camera.cos - right * camera.sin
    near = (Y > 120) & (np.abs(lateral) < GROUND_HALF) & (X % 7 != 0)
    luma, _ = resampled(skins, station / GROUND_PERIOD % 1.0, 0.5 + lateral / (2 * GROUND_HALF))
    assert near.sum() > 2048
    assert np.abs(canvas.light - luma * (1.0 + open_sky.direct))[near].max() < 1e-5
    assert canvas.clear[near].max() < 1e-6


def test_the_sky_fills_what_is_left(white: Skins) -> None:
    canvas = Canvas.blank(188, 642)
    canvas.clear[100:] = 0.25
    paint_sky(canvas, view(), white.texels, white.table[0])
    assert np.abs(canvas.light[:100] - 4.0).max() < 1e-5
    assert np.abs(canvas.light[100:] - 1.0).max() < 1e-5
    assert canvas.clear.max() < 1e-6


@given(st.lists(st.booleans(), max_size=40))
def test_what_a_hole_shows_is_dropped_from_the_batch(seen: list[bool]) -> None:
    pixels, kept = no_pixels(), np.flatnonzero(seen)
    carried = (pixels.x, pixels.y, pixels.clear, pixels.u, pixels.v, pixels.luma, pixels.alpha)
    for number, values in enumerate(carried, start=1):
        values[: len(seen)] = number + 10 * np.arange(len(seen))
    pixels.alpha[: len(seen)][~np.array(seen, bool)] = 0.0
    assert drop_unseen(pixels, len(seen)) == len(kept)
    for number, values in enumerate(carried, start=1):
        assert list(values[: len(kept)]) == list(number + 10 * kept)
