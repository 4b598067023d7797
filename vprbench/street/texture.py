"""Textures that are filtered beforehand at every pair of scales (ripmaps, McCabe and Caughlin 1991).

A street is seen at a grazing angle: its walls and ground shrink far more along the way than across it, so
each texture is stored halved any number of times in width and, apart from that, in height.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int64, UInt16
from numba import njit
from numpy.typing import NDArray

from vprbench.errors import ConfigError

__all__ = ["Image", "Skins", "choose_level", "sample", "stack_skins"]

# A level is halved once more as long as a pixel covers more of its texels than this (our choice: about
# the geometric middle of one and two).
_FINEST = 1.4
# Of single precision, so that the arithmetic of images stays in it.
_NONE, _HALF, _WHOLE, _WHITE = np.float32(0.0), np.float32(0.5), np.float32(1.0), np.float32(255.0)

# Reflectance 0..1 multiplied by opacity, and opacity 0..1.
Image = Float32[np.ndarray, "height width 2"]


class Skins(NamedTuple):
    """All textures of a street in one buffer.

    Attributes:
        texels: of every ripmap, luma (multiplied by alpha) in the high byte and alpha in the low one.
        table: (n, 3) row of the first texel, and the binary logarithms of width and height.
    """

    texels: UInt16[np.ndarray, " texels"]
    table: Int64[np.ndarray, "n 3"]


def stack_skins(images: Sequence[Image]) -> Skins:
    """The ripmaps of the images, one after the other; sides must be powers of two."""
    blocks, table, offset = [], [], 0
    for image in images:
        height, width = image.shape[:2]
        if width & (width - 1) or height & (height - 1):
            raise ConfigError(f"street: a texture of {width}x{height} texels: sides must be powers of two")
        blocks.append(_ripmap(image).reshape(-1))
        table.append((offset, width.bit_length() - 1, height.bit_length() - 1))
        offset += len(blocks[-1])
    return Skins(np.concatenate(blocks), np.array(table, np.int64))


@njit(cache=True)
def _ripmap(image: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Level (i, j), halved i times in width and j in height, lies at (2w - 2w/2^i, 2h - 2h/2^j).

    So entry w + k of a row, and h + k of a column, is the mean of entries 2k and 2k + 1.
    """
    height, width = image.shape[:2]
    levels = np.zeros((2 * height, 2 * width, 2), np.float32)
    levels[:height, :width] = image
    for k in range(height - 1):
        levels[height + k] = (levels[2 * k] + levels[2 * k + 1]) * _HALF
    texels = np.empty((2 * height, 2 * width), np.uint16)
    for y in range(2 * height):
        row = levels[y]
        for k in range(width - 1):
            for channel in range(2):
                row[width + k, channel] = (row[2 * k, channel] + row[2 * k + 1, channel]) * _HALF
        for x in range(2 * width):
            texels[y, x] = _byte(row[x, 0]) << 8 | _byte(row[x, 1])
    return texels


@njit(cache=True)
def _byte(share: np.float32) -> np.uint16:
    """A share of 0..1 in 0..255, rounded."""
    return np.uint16(min(max(share, _NONE), _WHOLE) * _WHITE + _HALF)


@njit(cache=True, error_model="numpy")
def choose_level(skin: NDArray[np.int64], footprint_u: float, footprint_v: float) -> tuple[int, int, int]:
    """First texel, width and height of the level whose texels are about as large as a pixel's footprint.

    Footprints are in parts of the texture's width and height.
    """
    width, height = 1 << skin[1], 1 << skin[2]
    w, h = width, height
    spread_u, spread_v = footprint_u * width, footprint_v * height
    while spread_u > _FINEST and w > 1:
        spread_u, w = spread_u * 0.5, w >> 1
    while spread_v > _FINEST and h > 1:
        spread_v, h = spread_v * 0.5, h >> 1
    return skin[0] + (2 * height - 2 * h) * 2 * width + 2 * width - 2 * w, w, h


@njit(cache=True, error_model="numpy", inline="always")
def sample(
    texels: NDArray[np.uint16], skin: NDArray[np.int64], level: tuple[int, int, int], u: float, v: float
) -> tuple[float, float]:
    """Luma (multiplied by alpha) and alpha, 0..255, of one level at (u, v) in 0..1, bilinear."""
    first, w, h = level
    stride = 2 << skin[1]
    x = min(max(u * w - 0.5, 0.0), w - 1.0)
    y = min(max(v * h - 0.5, 0.0), h - 1.0)
    x0, y0 = int(x), int(y)
    fx, fy = x - x0, y - y0
    at = first + y0 * stride + x0
    right = 1 if x0 < w - 1 else 0
    below = at + (stride if y0 < h - 1 else 0)
    a, b, c, d = texels[at], texels[at + right], texels[below], texels[below + right]
    wa, wb, wc, wd = (1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy
    luma = wa * (a >> 8) + wb * (b >> 8) + wc * (c >> 8) + wd * (d >> 8)
    alpha = wa * (a & 255) + wb * (b & 255) + wc * (c & 255) + wd * (d & 255)
    return luma, alpha
