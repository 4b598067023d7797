"""The camera's sensor: light to grey levels, with its exposure, its curve and its noise."""

from __future__ import annotations

from functools import cache

import numpy as np
from jaxtyping import Float32, UInt8
from numba import njit
from numpy.typing import NDArray

__all__ = ["develop"]

_GAMMA = 1 / 1.8
_STEPS = 4096
_CURVE = (255.0 * np.linspace(0.0, 1.0, _STEPS) ** _GAMMA).astype(np.float32)
# Light that saturates the sensor at exposure 0.
_WHITE = 1.9


def develop(
    light: Float32[np.ndarray, "height width"], stops: float, noise: float, rng: np.random.Generator
) -> UInt8[np.ndarray, "height width"]:
    """The picture of a painted canvas.

    Args:
        light: reflectance times illumination.
        stops: exposure; each stop doubles the light.
        noise: standard deviation, grey levels.
        rng: says where in the grain the noise starts.
    """
    start = int(rng.integers(0, _grain().size))
    return _develop(light, np.float32(2.0**stops / _WHITE * (_STEPS - 1)), np.float32(noise), _grain(), start, _CURVE)


@cache
def _grain() -> Float32[np.ndarray, " values"]:
    """Normal noise, more than two frames long; to draw it for every frame would take a fifth of the time."""
    return np.random.default_rng(0).standard_normal(1 << 18, np.float32)


@njit(cache=True, error_model="numpy")
def _develop(
    light: NDArray[np.float32],
    gain: np.float32,
    noise: np.float32,
    grain: NDArray[np.float32],
    start: int,
    curve: NDArray[np.float32],
) -> NDArray[np.uint8]:
    picture = np.empty(light.shape, np.uint8)
    half, black, white = np.float32(0.5), np.float32(0.0), np.float32(255.0)
    for y in range(light.shape[0]):
        for x in range(light.shape[1]):
            at = min(int(light[y, x] * gain), curve.size - 1)
            grey = curve[at] + noise * grain[start & (grain.size - 1)] + half
            picture[y, x] = np.uint8(min(max(grey, black), white))
            start += 1
    return picture
