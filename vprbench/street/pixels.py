"""Pixels on their way to the canvas: a batch of them goes through each step of the work together.

A step is a short loop over a few arrays, which the compiler keeps in registers and often in vector lanes, and
while one pixel waits for its texel the processor works on the next.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float64, Int32
from numba import njit

from vprbench.street.canvas import Canvas

__all__ = ["CAPACITY", "Pixels", "drop_unseen", "lay", "no_pixels"]

# Pixels in a batch: several rows of a frame, whose arrays (188 kB) stay in a core's cache. It must hold a row and a
# column of any picture.
CAPACITY = 2048

_Whole = Int32[np.ndarray, " capacity"]
_Real = Float64[np.ndarray, " capacity"]


class Pixels(NamedTuple):
    """Room for a batch; the first so many entries of each array count.

    A step may overwrite what no later step reads.

    Attributes:
        x, y: where in the picture.
        first, wide, high: the first texel of a level of the texture, and its width and height.
        clear: the share of the pixel that takes this light, 1..0.
        u, v: where in the texture, 0..1.
        luma, alpha: what the texture has there, 0..255.
        station, lateral, up: where in the street, metres.
        light: how brightly it is lit.
    """

    x: _Whole
    y: _Whole
    first: _Whole
    wide: _Whole
    high: _Whole
    clear: _Real
    u: _Real
    v: _Real
    luma: _Real
    alpha: _Real
    station: _Real
    lateral: _Real
    up: _Real
    light: _Real


@njit(cache=True)
def no_pixels() -> Pixels:
    """Room for a batch."""
    i, r = np.empty((5, CAPACITY), np.int32), np.empty((9, CAPACITY), np.float64)
    return Pixels(i[0], i[1], i[2], i[3], i[4], r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8])


@njit(cache=True, error_model="numpy")
def drop_unseen(pixels: Pixels, count: int) -> int:
    """Close up the batch where a texture has holes; how many pixels are left."""
    kept = 0
    while kept < count and pixels.alpha[kept] > 0.0:
        kept += 1
    for i in range(kept, count):
        if pixels.alpha[i] > 0.0:
            pixels.x[kept], pixels.y[kept], pixels.clear[kept] = pixels.x[i], pixels.y[i], pixels.clear[i]
            pixels.u[kept], pixels.v[kept] = pixels.u[i], pixels.v[i]
            pixels.luma[kept], pixels.alpha[kept] = pixels.luma[i], pixels.alpha[i]
            kept += 1
    return kept


@njit(cache=True, error_model="numpy")
def lay(canvas: Canvas, pixels: Pixels, count: int, white: float) -> None:
    """Lay the batch on the canvas; no pixel may come twice.

    `white` is the luma of what reflects all light: 1 where light is in parts of it already.
    """
    light, clear = pixels.light, pixels.alpha
    for i in range(count):
        light[i] = pixels.clear[i] * pixels.luma[i] * pixels.light[i] / white
        clear[i] = pixels.clear[i] * pixels.alpha[i] / 255.0
    for i in range(count):
        x, y = pixels.x[i], pixels.y[i]
        canvas.light[y, x] += light[i]
        canvas.clear[y, x] -= clear[i]
