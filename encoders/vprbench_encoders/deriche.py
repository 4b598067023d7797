"""The gradient of an image by Deriche's recursive filter.

R. Deriche, "Using Canny's criteria to derive a recursively implemented optimal edge detector", IJCV 1987. The
two kernels, sampled at whole pixels, are

    derivative  f(x) = -c x exp(-alpha |x|)                 smoothing  g(x) = k (alpha |x| + 1) exp(-alpha |x|)

and each is the sum of a causal and an anti-causal second-order recursion, so the cost does not grow as alpha
falls. Here k makes the smoothing sum to 1, and c makes the derivative of a ramp its slope.
"""

from __future__ import annotations

from math import exp
from typing import NamedTuple

import cv2
import numpy as np
from jaxtyping import Float32, UInt8
from numba import njit
from numpy.typing import NDArray

__all__ = ["gradient", "gradient_magnitude"]


class _Taps(NamedTuple):
    """Weights of one recursion y[n] = near x[n] + next x[n-1] + 2e y[n-1] - e^2 y[n-2], all float32.

    `steady` is what y settles at when x is 1 everywhere.
    """

    near: np.float32
    next: np.float32
    feedback: np.float32
    damping: np.float32
    steady: np.float32


class _Filter(NamedTuple):
    """A recursion that runs forward from x[n] and one that runs backward from x[n+1], added."""

    causal: _Taps
    anticausal: _Taps


def _taps(near: float, following: float, decay: float) -> _Taps:
    steady = (near + following) / (1 - decay) ** 2
    return _Taps(*map(np.float32, (near, following, 2 * decay, decay * decay, steady)))


def _derivative(alpha: float) -> _Filter:
    e = exp(-alpha)
    c = (1 - e) ** 3 / (2 * e * (1 + e))  # 1 / sum of x^2 exp(-alpha |x|)
    return _Filter(_taps(0.0, -c * e, e), _taps(c * e, 0.0, e))


def _smoothing(alpha: float) -> _Filter:
    e = exp(-alpha)
    k = (1 - e) ** 2 / (1 + 2 * alpha * e - e * e)
    return _Filter(_taps(k, k * e * (alpha - 1), e), _taps(k * e * (alpha + 1), -k * e * e, e))


@njit(cache=True)
def _recurse(
    image: NDArray[np.float32] | NDArray[np.uint8],
    taps: _Taps,
    lag: int,
    order: NDArray[np.int64],
    states: NDArray[np.float32],
    out: NDArray[np.float32],
) -> None:
    """Add to `out` one recursion down the rows visited in `order`, its input `lag` rows ahead of its output.

    The rows beyond the border repeat the border row: the filter starts in the state it would then have reached.
    """
    near, following, feedback, damping, steady = taps
    for j in range(image.shape[1]):
        states[0, j] = states[1, j] = np.float32(image[order[0], j]) * steady
    for step in range(len(order)):
        source, before = image[order[max(step - lag, 0)]], image[order[max(step - lag - 1, 0)]]
        # The newest state takes the place of the last but one, so that none is copied.
        last, last2 = states[step & 1], states[1 - (step & 1)]
        target = out[order[step]]
        for j in range(len(target)):
            driven = near * np.float32(source[j]) + following * np.float32(before[j])
            value = driven + feedback * last[j] - damping * last2[j]
            last2[j] = value
            target[j] += value


def _filter_down(
    image: Float32[np.ndarray, "height width"] | UInt8[np.ndarray, "height width"], filter_: _Filter
) -> Float32[np.ndarray, "height width"]:
    """The image filtered along its columns; whole rows advance together, so the recursion vectorises."""
    out, states = np.zeros(image.shape, np.float32), np.empty((2, image.shape[1]), np.float32)
    down = np.arange(len(image))
    _recurse(image, filter_.causal, 0, down, states, out)
    _recurse(image, filter_.anticausal, 1, down[::-1].copy(), states, out)
    return out


def _turned_gradient(
    image: Float32[np.ndarray, "height width"] | UInt8[np.ndarray, "height width"], alpha: float
) -> tuple[Float32[np.ndarray, "width height"], Float32[np.ndarray, "width height"]]:
    """The transposes of the derivatives along x and along y."""
    derivative, smoothing = _derivative(alpha), _smoothing(alpha)
    across = _filter_down(cv2.transpose(_filter_down(image, smoothing)), derivative)
    along = _filter_down(cv2.transpose(_filter_down(image, derivative)), smoothing)
    return across, along


def gradient(
    image: Float32[np.ndarray, "height width"], alpha: float = 1.0
) -> tuple[Float32[np.ndarray, "height width"], Float32[np.ndarray, "height width"]]:
    """The derivatives along x and along y, in grey levels per pixel; the border is repeated outwards."""
    across, along = _turned_gradient(image, alpha)
    return cv2.transpose(across), cv2.transpose(along)


def gradient_magnitude(
    frame: UInt8[np.ndarray, "height width"], alpha: float = 1.0
) -> Float32[np.ndarray, "height width"]:
    """The length of the Deriche gradient at every pixel, in grey levels per pixel."""
    return cv2.transpose(cv2.magnitude(*_turned_gradient(np.ascontiguousarray(frame), alpha)))
