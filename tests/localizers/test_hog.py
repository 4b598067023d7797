from __future__ import annotations

from typing import get_args

import numpy as np
import pytest
from numpy.typing import NDArray

from vprbench.checks.samples import textured_frame
from vprbench_localizers.hog import Magnitude, _histograms, cell_histograms


def histogram(angle: float, strength: float = 1.0) -> NDArray[np.float64]:
    """The histogram of one cell in which a single pixel has any strength."""
    angles, strengths = np.zeros((16, 16)), np.zeros((16, 16))
    angles[7, 3], strengths[7, 3] = angle, strength
    cells: NDArray[np.float64] = _histograms(strengths, angles)
    assert cells.shape == (1, 1, 8)
    return cells[0, 0]


@pytest.mark.parametrize(
    ("angle", "shares"),
    [
        (0.0, {0: 1.0}),
        (45.0, {1: 1.0}),
        (315.0, {7: 1.0}),
        (67.5, {1: 0.5, 2: 0.5}),
        (99.0, {2: 0.8, 3: 0.2}),
        (337.5, {7: 0.5, 0: 0.5}),
        (360.0, {7: 1.0}),
    ],
)
def test_a_pixel_is_split_between_the_two_nearest_directions(angle: float, shares: dict[int, float]) -> None:
    expected = [shares.get(direction, 0.0) for direction in range(8)]
    np.testing.assert_allclose(histogram(angle), expected, atol=1e-12)


def test_a_negative_strength_counts_by_its_size() -> None:
    np.testing.assert_allclose(histogram(99.0, -5.0), histogram(99.0, 5.0))


def test_each_pixel_counts_for_its_own_cell() -> None:
    angles, strengths = np.zeros((32, 48)), np.zeros((32, 48))
    strengths[15, 16], strengths[16, 15], strengths[31, 47] = 1.0, 2.0, 3.0
    strength: NDArray[np.float64] = _histograms(strengths, angles).sum(axis=2)
    assert strength.tolist() == [[0.0, 1.0, 0.0], [2.0, 0.0, 3.0]]


@pytest.mark.parametrize("quarter_turns", range(4))
def test_a_step_from_dark_to_bright_points_to_the_bright_side(quarter_turns: int) -> None:
    image = np.full((64, 64), 50, np.uint8)
    image[:, 32:] = 200
    # rot90 turns against the clock, and angles grow with the clock because rows count downwards.
    cells = cell_histograms(np.ascontiguousarray(np.rot90(image, -quarter_turns)))
    directions = cells.sum(axis=(0, 1))
    assert directions[2 * quarter_turns] > 0
    np.testing.assert_allclose(directions, np.where(np.arange(8) == 2 * quarter_turns, directions.max(), 0), atol=1e-6)


def test_the_mean_magnitude_is_blind_where_the_two_gradients_cancel() -> None:
    rows, columns = np.mgrid[:64, :64]
    image = np.asarray(100 + rows - columns, np.uint8)
    # Cells at the border also see its reflection.
    seen = {name: cell_histograms(image, name)[1:-1, 1:-1].sum() for name in get_args(Magnitude)}
    assert seen["mean"] < 1e-9 < 1e3 < seen["hypot"]


def plain_histograms(image: NDArray[np.uint8], magnitude: Magnitude) -> NDArray[np.float64]:
    """The same by plain convolution with the 5 x 5 Sobel masks and the exact arc tangent."""
    shaded = np.pad(255 * np.sqrt(image / image.max()), 2, mode="reflect")
    mask = np.outer([1, 4, 6, 4, 1], [-1, -2, 0, 2, 1])
    windows = np.lib.stride_tricks.sliding_window_view(shaded, (5, 5))
    gx, gy = (windows * mask).sum(axis=(2, 3)), (windows * mask.T).sum(axis=(2, 3))
    strength = np.hypot(gx, gy) if magnitude == "hypot" else np.abs(gx + gy) / 2
    position = np.arctan2(gy, gx) % (2 * np.pi) / (np.pi / 4)
    distance = np.abs(position[..., None] - np.arange(8))
    shares = np.maximum(1 - np.minimum(distance, 8 - distance), 0)
    cells = (shares * strength[..., None]).reshape(len(image) // 16, 16, -1, 16, 8)
    return np.asarray(cells.sum(axis=(1, 3)))


@pytest.mark.parametrize("magnitude", get_args(Magnitude))
def test_the_histograms_are_those_of_a_plain_convolution(magnitude: Magnitude) -> None:
    image = textured_frame(3)[:176, :640]
    cells, plain = cell_histograms(np.ascontiguousarray(image), magnitude), plain_histograms(image, magnitude)
    # cv2.phase is right to about 0.01 degrees.
    np.testing.assert_allclose(cells, plain, atol=1e-3 * plain.max())
    np.testing.assert_allclose(cells.sum(axis=2), plain.sum(axis=2), rtol=1e-9)


def test_brightness_is_relative_to_the_brightest_pixel() -> None:
    image = textured_frame(4)[:160, :160] // 2
    np.testing.assert_array_equal(cell_histograms(image), cell_histograms(image * 2))


@pytest.mark.parametrize("grey", [0, 1, 77, 255])
def test_a_uniform_image_has_no_gradient(grey: int) -> None:
    cells = cell_histograms(np.full((64, 64), grey, np.uint8))
    assert cells.shape == (4, 4, 8)
    assert not cells.any()
