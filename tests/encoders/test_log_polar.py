from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jaxtyping import Float32
from scipy.ndimage import map_coordinates
from scipy.spatial.distance import cdist

from vprbench.agents import build_encoder
from vprbench.errors import ConfigError
from vprbench.protocols import Encoder
from vprbench.types import Frame
from vprbench_encoders.log_polar import LogPolar, area_average, log_polar_grid, sample_log_polar

GRID = log_polar_grid(2.0, 27.0)
SIZES = pytest.mark.parametrize("size", [6, 9, 12, 15, 27])


def scene(seed: int = 0) -> Frame:
    """A smooth random frame with structure everywhere."""
    coarse = np.random.default_rng(seed).integers(0, 256, (24, 80), dtype=np.uint8)
    return cv2.resize(coarse, (642, 188), interpolation=cv2.INTER_CUBIC).astype(np.uint8)


def signatures(seed: int, rows: int, size: int) -> Float32[np.ndarray, "rows size"]:
    return np.random.default_rng(seed).random((rows, size), np.float32)


def spiral(turn: float = 0.0, growth: float = 1.0) -> Float32[np.ndarray, "1 2916"]:
    """The log-polar map of a smooth pattern around (40, 40), turned and magnified."""
    v, u = (np.mgrid[:81, :81] - 40) / growth
    radius, angle = np.hypot(u, v), np.arctan2(v, u) - turn
    image = 0.5 + 0.3 * np.cos(2 * angle) * np.exp(-((radius - 10) ** 2) / 80) + 0.2 * np.sin(radius / 5)
    return sample_log_polar(image.astype(np.float32), np.array([[40, 40]], np.float32), GRID)


def test_the_grid_grows_by_one_factor_and_turns_by_one_angle() -> None:
    samples = (GRID[0] + 1j * GRID[1]).reshape(54, 54)
    np.testing.assert_allclose(abs(samples[[0, -1]]), [[2.0] * 54, [27.0] * 54], rtol=1e-6)
    np.testing.assert_allclose(samples[1:] / samples[:-1], 13.5 ** (1 / 53), rtol=1e-5)
    np.testing.assert_allclose(samples[:, 1:] / samples[:, :-1], np.exp(2j * np.pi / 54), rtol=1e-5)
    np.testing.assert_allclose(samples[:, 0].imag, 0.0, atol=1e-6)


def test_samples_are_bilinear_with_the_border_repeated() -> None:
    rng = np.random.default_rng(0)
    image = rng.random((60, 80), np.float32)
    points = (rng.random((40, 2)) * [79, 59]).astype(np.float32)
    points[0], points[1] = (79, 59), (0, 0)
    u, v = points[:, :1] + GRID[0], points[:, 1:] + GRID[1]
    expected = map_coordinates(image.astype(np.float64), [v, u], order=1, mode="nearest")
    np.testing.assert_allclose(sample_log_polar(image, points, GRID), expected, atol=2e-5)


def test_a_turned_pattern_shifts_the_columns() -> None:
    plain, turned = spiral().reshape(54, 54), spiral(turn=2 * np.pi * 10 / 54).reshape(54, 54)
    np.testing.assert_allclose(np.roll(plain, 10, axis=1), turned, atol=0.015)
    assert abs(plain - turned).max() > 0.3


def test_a_magnified_pattern_shifts_the_rows() -> None:
    plain, grown = spiral().reshape(54, 54), spiral(growth=13.5 ** (8 / 53)).reshape(54, 54)
    np.testing.assert_allclose(plain[:-8], grown[8:], atol=0.015)
    assert abs(plain - grown).max() > 0.1


def test_a_frame_gives_one_scaled_signature_a_point_and_always_the_same() -> None:
    encoder = LogPolar()
    landmarks = encoder.encode(scene())
    assert landmarks.signatures.shape == (25, 2916)
    assert landmarks.signatures.dtype == landmarks.points.dtype == np.float32
    assert landmarks.signatures.min() >= 0
    np.testing.assert_array_equal(landmarks.signatures.max(axis=1), 1.0)
    again = encoder.encode(scene())
    np.testing.assert_array_equal(landmarks.signatures, again.signatures)
    np.testing.assert_array_equal(landmarks.points, again.points)


def test_contrast_does_not_change_a_signature() -> None:
    frame = scene()
    bright, dim = LogPolar().encode(frame // 2 * 2), LogPolar().encode(frame // 2)
    np.testing.assert_array_equal(bright.points, dim.points)
    np.testing.assert_allclose(bright.signatures, dim.signatures, atol=1e-4)


@SIZES
def test_a_shrunk_signature_is_the_area_average_of_the_whole_one(size: int) -> None:
    whole, shrunk = LogPolar().encode(scene()), LogPolar(size=size).encode(scene())
    np.testing.assert_array_equal(whole.points, shrunk.points)
    expected = [cv2.resize(row.reshape(54, 54), (size, size), interpolation=cv2.INTER_AREA) for row in whole.signatures]
    np.testing.assert_allclose(shrunk.signatures, np.reshape(expected, (25, -1)), atol=1e-5)


@SIZES
def test_each_size_has_a_name(size: int) -> None:
    encoder = build_encoder(f"log-polar-{size}")
    assert isinstance(encoder, LogPolar)
    assert encoder.size == size


@pytest.mark.parametrize("size", [1, 5, 12, 15, 54])
def test_an_area_average_counts_cut_samples_in_part(size: int) -> None:
    values = np.random.default_rng(0).random(54)
    np.testing.assert_allclose(
        area_average(size) @ values, values.repeat(size).reshape(size, 54).mean(axis=1), rtol=1e-5
    )


def test_a_frame_without_gradient_has_no_landmarks() -> None:
    for encoder, size in (LogPolar(), 2916), (LogPolar(size=6), 36):
        landmarks = encoder.encode(np.full((188, 642), 90, np.uint8))
        assert landmarks.signatures.shape == (0, size)
        assert landmarks.points.shape == (0, 2)
        assert encoder.match(landmarks.signatures, signatures(0, 3, size)).shape == (0, 3)
        assert encoder.match(signatures(0, 3, size), landmarks.signatures).shape == (3, 0)


@settings(max_examples=20, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1), points=st.integers(1, 9), units=st.integers(1, 9), size=st.sampled_from([36, 2916])
)
def test_match_is_one_minus_the_mean_difference(seed: int, points: int, units: int, size: int) -> None:
    queries, memory = signatures(seed, points, size), signatures(seed + 1, units, size)
    match = LogPolar().match(queries, memory)
    assert match.dtype == np.float32
    np.testing.assert_allclose(match, 1 - cdist(queries, memory, "cityblock") / size, atol=1e-6)
    np.testing.assert_array_equal(match, LogPolar().match(memory, queries).T)
    np.testing.assert_array_equal(np.diag(LogPolar().match(queries, queries)), 1.0)


def test_chosen_pairs_match_bitwise_as_all_pairs_do() -> None:
    queries, memory = signatures(0, 25, 2916), signatures(1, 40, 2916)
    rng = np.random.default_rng(2)
    p, m = rng.integers(0, 25, 300), rng.integers(0, 40, 300)
    np.testing.assert_array_equal(
        LogPolar().match_pairs(queries, memory, p, m), LogPolar().match(queries, memory)[p, m]
    )


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), size=st.sampled_from([1, 36, 81, 2916]))
def test_maps_of_bytes_match_by_their_whole_numbers(seed: int, size: int) -> None:
    rng = np.random.default_rng(seed)
    queries, memory = (rng.integers(0, 256, (rows, size), np.uint8) for rows in (5, 7))
    p, m = rng.integers(0, 5, 30), rng.integers(0, 7, 30)
    difference = cdist(queries, memory, "cityblock")[p, m].astype(np.float32)
    found = LogPolar().match_pairs(queries, memory, p, m)
    np.testing.assert_array_equal(found, np.float32(1) - difference / np.float32(255 * size))


def test_black_and_white_maps_of_bytes_have_nothing_in_common() -> None:
    black, white, first = np.zeros((1, 2916), np.uint8), np.full((1, 2916), 255, np.uint8), np.zeros(1, np.int64)
    for one, other, match in ((black, white, 0.0), (white, black, 0.0), (white, white, 1.0)):
        assert LogPolar().match_pairs(one, other, first, first) == match


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), blend=st.floats(0.0, 1.0), shift=st.floats(0.0, 0.5))
def test_no_match_exceeds_what_sketches_allow(seed: int, blend: float, shift: float) -> None:
    """Of maps that are alike to any degree; and sketches tell all where one map is brighter throughout."""
    encoder, rng, index = LogPolar(), np.random.default_rng(seed), np.zeros(1, np.int64)
    one, other = rng.random((2, 1, 2916), np.float32)
    mixed = np.float32(blend) * one + np.float32(1 - blend) * other
    assert encoder.sketch(one).shape == (1, 162)
    assert encoder.sketch(one)[0, 28] == pytest.approx(one.reshape(54, 54)[9:18, 2:4].mean(), rel=1e-5)
    for w in (mixed, one, 1 - one):
        assert encoder.match_at_most(encoder.sketch(one), encoder.sketch(w), index, index) >= encoder.match(one, w)[0]
    brighter = one / 2 + np.float32(shift)
    bound = encoder.match_at_most(encoder.sketch(one / 2), encoder.sketch(brighter), index, index)
    assert bound == pytest.approx(encoder.match(one / 2, brighter)[0], abs=2e-3)


def test_it_is_an_encoder() -> None:
    assert isinstance(LogPolar(), Encoder)


def test_impossible_options_are_refused_by_name() -> None:
    for size in (0, 55):
        with pytest.raises(ConfigError, match="size"):
            LogPolar(size=size)
    with pytest.raises(ConfigError, match="radii"):
        LogPolar(inner_radius=30.0)
    with pytest.raises(ConfigError, match="points"):
        LogPolar(points=0)
