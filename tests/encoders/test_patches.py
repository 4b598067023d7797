from __future__ import annotations

import numpy as np
import pytest

from vprbench_encoders.patches import LocalView, jittered

VIEW = LocalView()
V, U = np.mgrid[:94, :321].astype(np.float32)


def centre(image: np.ndarray, points: list[list[float]], view: LocalView = VIEW) -> np.ndarray:
    """The middle pixel of each view, before its mean was removed."""
    squares = view.picture(view.cut(image, np.array(points, np.float32)))
    corner, border = squares[:, view.side // 2, view.side // 2], squares[:, view.side // 2, 0]
    return corner - border


def test_the_disk_has_the_area_of_a_circle() -> None:
    assert VIEW.disk.shape == (27, 27)
    assert VIEW.size == pytest.approx(np.pi * 13.5**2, rel=0.02)
    np.testing.assert_array_equal(VIEW.disk, VIEW.disk.T)
    np.testing.assert_array_equal(VIEW.disk, VIEW.disk[::-1])


@pytest.mark.parametrize("point", [[100, 60], [101, 61], [27, 27], [614, 160]])
def test_a_view_is_centred_on_its_point_at_half_resolution(point: list[float]) -> None:
    spot = np.zeros((94, 321), np.float32)
    spot[int(point[1]) // 2, int(point[0]) // 2] = 1
    square = VIEW.picture(VIEW.cut(spot, np.array([point], np.float32)))[0]
    assert np.unravel_index(square.argmax(), square.shape) == (13, 13)


def test_a_view_beyond_the_border_is_cut_within() -> None:
    points = np.array([[0, 0], [641, 187], [13, 100]], np.float32)
    inside = np.array([[26, 26], [614, 160], [26, 100]], np.float32)
    image = np.random.default_rng(0).random((94, 321), np.float32)
    np.testing.assert_array_equal(VIEW.cut(image, points), VIEW.cut(image, inside))


def test_a_view_has_no_mean_and_knows_no_brightness() -> None:
    image = np.random.default_rng(0).random((94, 321), np.float32)
    points = np.array([[100, 60], [300, 90]], np.float32)
    views = VIEW.cut(image, points)
    np.testing.assert_allclose(views.mean(axis=1), 0, atol=1e-6)
    np.testing.assert_allclose(VIEW.cut(image + 7, points), views, atol=1e-5)


def test_a_picture_is_what_was_cut() -> None:
    image = np.random.default_rng(0).random((94, 321), np.float32)
    square = VIEW.picture(VIEW.cut(image, np.array([[100, 60]], np.float32)))[0]
    window = image[30 - 13 : 30 + 14, 50 - 13 : 50 + 14]
    np.testing.assert_allclose(square[VIEW.disk], window[VIEW.disk] - window[VIEW.disk].mean(), atol=1e-6)
    np.testing.assert_array_equal(square[~VIEW.disk], 0)


def test_no_points_have_no_views() -> None:
    assert VIEW.cut(V, np.empty((0, 2), np.float32)).shape == (0, VIEW.size)


def test_jitter_moves_all_copies_but_the_first_within_its_reach() -> None:
    points = np.array([[100, 60], [300, 90], [200, 80]], np.float32)
    moved = jittered(points, 6, 400, np.random.default_rng(0)).reshape(400, 3, 2) - points
    np.testing.assert_array_equal(moved[0], 0)
    assert sorted(np.unique(moved[1:])) == list(range(-6, 7))
    # Uniform on -6..6 has mean 0 and variance 14.
    assert abs(moved[1:].mean()) < 0.3
    assert moved[1:].var() == pytest.approx(14, rel=0.1)
