"""The camera's sensor: light to grey levels, with its exposure, its curve and its noise."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, UInt8
from numba import njit

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
        rng: draws the noise.
    """
    grain = rng.standard_normal(light.shape, np.float32)
    return _develop(light, np.float32(2.0**stops / _WHITE * (_STEPS - 1)), np.float32(noise), grain, _CURVE)


@njit(cache=True, error_model="numpy")
def _develop(light, gain, noise, grain, curve):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
    picture = np.empty(light.shape, np.uint8)
    for y in range(light.shape[0]):
        for x in range(light.shape[1]):
            at = min(int(light[y, x] * gain), curve.size - 1)
            grey = curve[at] + noise * grain[y, x] + np.float32(0.5)
            picture[y, x] = np.uint8(min(max(grey, np.float32(0.0)), np.float32(255.0)))
    return picture
