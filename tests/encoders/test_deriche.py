from __future__ import annotations

import numpy as np
import pytest
from jaxtyping import Float64
from scipy.ndimage import convolve1d

from vprbench_encoders.deriche import gradient, gradient_magnitude

ALPHAS = pytest.mark.parametrize("alpha", [0.5, 1.0, 2.0])


def kernels(alpha: float) -> tuple[Float64[np.ndarray, " taps"], Float64[np.ndarray, " taps"]]:
    """The closed forms, long enough that what is cut off is below rounding."""
    x = np.arange(-80, 81)
    derivative = -x * np.exp(-alpha * abs(x))
    smoothing = (alpha * abs(x) + 1) * np.exp(-alpha * abs(x))
    return derivative / -(x * derivative).sum(), smoothing / smoothing.sum()


@ALPHAS
def test_recursion_equals_convolution_with_the_closed_forms(alpha: float) -> None:
    image = np.random.default_rng(0).random((37, 52))
    derivative, smoothing = kernels(alpha)
    along_x = convolve1d(convolve1d(image, derivative, axis=1, mode="nearest"), smoothing, axis=0, mode="nearest")
    along_y = convolve1d(convolve1d(image, derivative, axis=0, mode="nearest"), smoothing, axis=1, mode="nearest")
    x, y = gradient(image.astype(np.float32), alpha)
    np.testing.assert_allclose(x, along_x, atol=1e-5)
    np.testing.assert_allclose(y, along_y, atol=1e-5)


@ALPHAS
def test_gradient_of_a_plane_is_its_slope(alpha: float) -> None:
    v, u = np.mgrid[:120, :140]
    x, y = gradient((1.5 * u - 0.75 * v + 20).astype(np.float32), alpha)
    inside = np.s_[45:-45, 45:-45]
    np.testing.assert_allclose(x[inside], 1.5, rtol=1e-4)
    np.testing.assert_allclose(y[inside], -0.75, rtol=1e-4)


def test_a_uniform_frame_has_no_gradient_up_to_its_border() -> None:
    assert gradient_magnitude(np.full((40, 60), 255, np.uint8)).max() < 1e-4


def test_magnitude_turns_with_the_frame() -> None:
    frame = np.random.default_rng(1).integers(0, 256, (40, 60), dtype=np.uint8)
    np.testing.assert_allclose(gradient_magnitude(frame.T), gradient_magnitude(frame).T, atol=1e-3)
    np.testing.assert_allclose(gradient_magnitude(frame[::-1]), gradient_magnitude(frame)[::-1], atol=1e-3)


def test_magnitude_is_the_length_of_both_derivatives() -> None:
    frame = np.random.default_rng(2).integers(0, 256, (30, 30), dtype=np.uint8)
    x, y = gradient(frame.astype(np.float32))
    np.testing.assert_allclose(gradient_magnitude(frame), np.hypot(x, y), rtol=1e-5)
