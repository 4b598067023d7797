from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter, maximum_filter

from vprbench.errors import ConfigError, DataError
from vprbench.types import Frame
from vprbench_encoders.focus import FocusDetector


def blobs(*spots: tuple[int, int, int]) -> Frame:
    """A dark frame with 3 x 3 squares at (u, v), of a brightness."""
    frame = np.zeros((188, 642), np.uint8)
    for u, v, brightness in spots:
        frame[v - 1 : v + 2, u - 1 : u + 2] = brightness
    return frame


def find(frame: Frame, detector: FocusDetector | None = None) -> list[list[float]]:
    detector = detector or FocusDetector()
    points: list[list[float]] = detector.find(detector.gradient(frame)).tolist()
    return points


def noise(seed: int, height: int = 90, width: int = 120) -> Frame:
    return np.random.default_rng(seed).integers(0, 256, (height, width), dtype=np.uint8)


def test_points_stand_on_the_blobs_the_brightest_first() -> None:
    assert find(blobs((100, 60, 90), (300, 100, 250), (500, 80, 170))) == [[300, 100], [500, 80], [100, 60]]


def test_a_stronger_neighbour_within_the_radius_wins() -> None:
    frame = blobs((100, 60, 180), (115, 60, 250), (300, 60, 210))
    assert find(frame) == [[115, 60], [300, 60]]
    assert find(frame, FocusDetector(radius=15.0)) == [[115, 60], [300, 60], [100, 60]]


def test_nothing_is_found_in_the_margin() -> None:
    outside = [(26, 60), (615, 120), (300, 26), (400, 161)]
    inside = [(27, 120), (614, 60), (300, 160), (400, 27)]
    points = find(blobs(*((u, v, 200) for u, v in outside + inside)))
    assert sorted(points) == sorted(list(map(float, spot)) for spot in inside)


def test_equal_blobs_come_in_reading_order() -> None:
    # Multiples of 32 columns apart, so that every vector width rounds each blob alike.
    spots = [(100, 60), (420, 60), (100, 120), (260, 120)]
    assert find(blobs(*((u, v, 200) for u, v in reversed(spots)))) == [list(map(float, spot)) for spot in spots]


@pytest.mark.parametrize("level", [0, 77, 255])
def test_a_frame_without_gradient_has_no_points(level: int) -> None:
    detector = FocusDetector()
    assert detector.find(detector.gradient(np.full((188, 642), level, np.uint8))).shape == (0, 2)


def test_a_frame_smaller_than_its_margins_has_no_points() -> None:
    assert find(noise(0, 50, 50)) == []


def test_one_grey_level_is_above_the_floor() -> None:
    frame = np.full((188, 642), 100, np.uint8)
    frame[90, 300] = 101
    assert find(frame) == [[300, 90]]


def test_saliency_is_a_difference_of_gaussians() -> None:
    detector = FocusDetector(sigmas=(1.5, 3.0))
    gradient = detector.gradient(noise(1))
    expected = gaussian_filter(gradient, 1.5, mode="mirror") - gaussian_filter(gradient, 3.0, mode="mirror")
    np.testing.assert_allclose(detector.saliency(gradient), expected, atol=2e-4 * gradient.max())


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    radius=st.floats(0, 40),
    points=st.integers(1, 60),
    margin=st.integers(1, 40),
)
def test_points_are_the_greedy_choice_among_local_maxima(seed: int, radius: float, points: int, margin: int) -> None:
    detector = FocusDetector(radius=radius, points=points, margin=margin)
    gradient = detector.gradient(noise(seed))
    saliency = detector.saliency(gradient)
    peaks = (maximum_filter(saliency, 3) == saliency) & (saliency > detector.floor)
    candidates = sorted(
        (-saliency[v, u], v, u)
        for v, u in zip(*peaks.nonzero(), strict=True)
        if margin <= v < 90 - margin and margin <= u < 120 - margin
    )
    kept: list[tuple[int, int]] = []
    for _, v, u in candidates:
        if len(kept) < points and all((u - a) ** 2 + (v - b) ** 2 >= np.float32(radius) ** 2 for a, b in kept):
            kept.append((u, v))
    assert list(map(tuple, detector.find(gradient).tolist())) == kept


@pytest.mark.parametrize("reduction", [2, 3])
def test_points_of_a_reduced_frame_are_those_of_the_small_one_at_its_scale(reduction: int) -> None:
    small = noise(3)
    large = small.repeat(reduction, axis=0).repeat(reduction, axis=1)
    fine = FocusDetector(alpha=0.75, sigmas=(2.0 * reduction, 4.0 * reduction), radius=9.0 * reduction, margin=27)
    coarse = FocusDetector(alpha=0.75 * reduction, sigmas=(2.0, 4.0), radius=9.0, margin=-(-27 // reduction))
    u, v = np.array(find(small, coarse)).T
    assert len(u) > 10
    # Pixel u of the small frame is pixels u r .. u r + r - 1 of the large one.
    middle = (reduction - 1) / 2
    np.testing.assert_array_equal(fine.points_of(large, reduction), np.stack([u, v], axis=1) * reduction + middle)


def test_a_reduced_frame_has_its_points_where_the_whole_one_has() -> None:
    spots = [(300, 100, 250), (500, 81, 170), (101, 60, 90)]
    for reduction in (1, 2):
        points = FocusDetector().points_of(blobs(*spots), reduction)
        assert np.abs(points - np.array(spots)[:, :2]).max() <= reduction / 2


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"sigmas": (4.0, 2.0)}, "sigmas"),
        ({"sigmas": (0.0, 2.0)}, "sigmas"),
        ({"alpha": 0.0}, "alpha"),
        ({"alpha": float("nan")}, "alpha"),
        ({"points": 0}, "points"),
        ({"radius": -1.0}, "radius"),
        ({"margin": 0}, "margin"),
        ({"floor": -1.0}, "floor"),
    ],
)
def test_impossible_options_are_refused_by_name(options: dict[str, float], named: str) -> None:
    with pytest.raises(ConfigError, match=named):
        FocusDetector(**options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "frame", [np.zeros((188, 642, 3), np.uint8), np.zeros((188, 642), np.float32), np.zeros((0, 5), np.uint8)]
)
def test_what_is_no_grey_frame_is_refused(frame: np.ndarray) -> None:
    for reduction in (1, 2):
        with pytest.raises(DataError, match="grey uint8"):
            FocusDetector().points_of(frame, reduction)
