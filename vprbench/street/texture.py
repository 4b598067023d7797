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
from vprbench.street.pixels import Pixels

__all__ = ["RUN", "Image", "Skins", "choose_level", "sample", "stack_skins"]

# Along a row levels are chosen anew every so many pixels (a power of two).
RUN = 8
# A level is halved once more as long as a pixel covers more of its texels than this (our choice: about
# the geometric middle of one and two).
_FINEST = 1.4
_NEXT = np.uint32(1)
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


def _ripmap(image: Image) -> UInt16[np.ndarray, "height2 width2"]:
    """Level (i, j), halved i times in width and j in height, lies at (2w - 2w/2^i, 2h - 2h/2^j)."""
    height, width = image.shape[:2]
    levels = np.zeros((2 * height, 2 * width, 2), np.float32)
    levels[:height, :width] = image
    return _halve(levels, height, width)


@njit(cache=True)
def _halve(levels: NDArray[np.float32], height: int, width: int) -> NDArray[np.uint16]:
    """The texels of all levels; entry w + k of a row, and h + k of a column, is the mean of entries 2k and 2k + 1."""
    for k in range(height - 1):
        for x in range(width):
            for channel in range(2):
                levels[height + k, x, channel] = (levels[2 * k, x, channel] + levels[2 * k + 1, x, channel]) * _HALF
    texels = np.empty(levels.shape[:2], np.uint16)
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


@njit(cache=True, error_model="numpy")
def sample(texels: NDArray[np.uint16], skin: NDArray[np.int64], pixels: Pixels, count: int) -> None:
    """Find luma (multiplied by alpha) and alpha of a batch, each at (u, v) of its level, bilinear.

    The texels to the right and below always exist: where a level ends they count nothing.
    """
    stride = np.int32(2 << skin[1])
    at, right, down = pixels.first, pixels.luma, pixels.alpha
    for i in range(count):
        x = min(max(0.0, pixels.u[i] * pixels.wide[i] - 0.5), pixels.wide[i] - 1.0)
        y = min(max(0.0, pixels.v[i] * pixels.high[i] - 0.5), pixels.high[i] - 1.0)
        column, row = np.int32(x), np.int32(y)
        at[i] += row * stride + column
        right[i], down[i] = x - column, y - row
    for i in range(count):
        upper, fx, fy = np.uint32(at[i]), right[i], down[i]
        lower = np.uint32(upper + stride)
        a, b, c, d = texels[upper], texels[upper + _NEXT], texels[lower], texels[lower + _NEXT]
        wa, wb, wc, wd = (1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy
        pixels.luma[i] = wa * (a >> 8) + wb * (b >> 8) + wc * (c >> 8) + wd * (d >> 8)
        pixels.alpha[i] = wa * (a & 255) + wb * (b & 255) + wc * (c & 255) + wd * (d & 255)
