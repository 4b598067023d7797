"""The painter of the sky, which fills what is left above the horizon."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.street.canvas import OPAQUE, Canvas, View
from vprbench.street.pixels import CAPACITY, lay, no_pixels
from vprbench.street.texture import choose_level, sample

__all__ = ["paint_sky"]

# Elevation of the sky texture's upper edge, radians.
_TOP = 0.5
# How much brighter than sunlit white paper the sky's texture may be.
_LIGHT = 4.0


@njit(cache=True, error_model="numpy")
def paint_sky(canvas: Canvas, view: View, texels: NDArray[np.uint16], skin: NDArray[np.int64]) -> None:
    """Paint the sky, a texture at infinity that spans the whole round of azimuths."""
    heading, pixels, count = np.arctan2(view.sin, view.cos), no_pixels(), 0
    for x in range(view.width):
        rx = (x - view.cx) / view.fx
        azimuth = (heading + np.arctan(rx)) / (2 * np.pi)
        u = azimuth - np.floor(azimuth)
        slant = np.sqrt(1.0 + rx * rx)
        level = choose_level(skin, 1.0 / (view.fx * slant * slant * 2 * np.pi), 1.0 / (view.fy * _TOP))
        for y in range(view.height):
            clear = canvas.clear[y, x]
            if clear > OPAQUE:
                pixels.x[count], pixels.y[count], pixels.clear[count], pixels.light[count] = x, y, clear, _LIGHT
                pixels.u[count], pixels.v[count] = u, 1.0 - (view.cy - y) / (view.fy * slant * _TOP)
                pixels.first[count], pixels.wide[count], pixels.high[count] = level
                count += 1
        if x == view.width - 1 or count + view.height > CAPACITY:
            sample(texels, skin, pixels, count)
            lay(canvas, pixels, count, 255.0)
            count = 0
