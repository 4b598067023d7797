"""Textures that are filtered beforehand at every pair of scales (ripmaps, McCabe and Caughlin 1991).

A street is seen at a grazing angle: its walls and ground shrink far more along the way than across it, so
each texture is stored halved any number of times in width and, apart from that, in height.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int64, UInt8
from numba import njit

from vprbench.errors import ConfigError

__all__ = ["Image", "Skins", "sample", "stack_skins"]

# Reflectance 0..1 multiplied by opacity, and opacity 0..1.
Image = Float32[np.ndarray, "height width 2"]


class Skins(NamedTuple):
    """All textures of a street in one buffer.

    Attributes:
        texels: luma (multiplied by alpha) and alpha of every texel of every ripmap.
        table: (n, 3) row of the first texel, and the binary logarithms of width and height.
    """

    texels: UInt8[np.ndarray, "texels 2"]
    table: Int64[np.ndarray, "n 3"]


def stack_skins(images: Sequence[Image]) -> Skins:
    """The ripmaps of the images, one after the other; sides must be powers of two."""
    blocks, table, offset = [], [], 0
    for image in images:
        height, width = image.shape[:2]
        if width & (width - 1) or height & (height - 1):
            raise ConfigError(f"street: a texture of {width}x{height} texels: sides must be powers of two")
        blocks.append(_ripmap(image).reshape(-1, 2))
        table.append((offset, width.bit_length() - 1, height.bit_length() - 1))
        offset += len(blocks[-1])
    return Skins(np.concatenate(blocks), np.array(table, np.int64))


def _ripmap(image: Image) -> UInt8[np.ndarray, "height2 width2 2"]:
    """Level (i, j), halved i times in width and j in height, lies at (2w - 2w/2^i, 2h - 2h/2^j)."""
    rows = np.concatenate(_halvings(image, axis=0), axis=0)
    both = np.concatenate(_halvings(rows, axis=1), axis=1)
    full = np.pad(both, ((0, 1), (0, 1), (0, 0)))
    return (np.clip(full, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def _halvings(image: Image, axis: int) -> list[Image]:
    levels = [np.moveaxis(image, axis, 0)]
    while len(levels[-1]) > 1:
        levels.append((levels[-1][0::2] + levels[-1][1::2]) * np.float32(0.5))
    return [np.moveaxis(level, 0, axis) for level in levels]


@njit(cache=True, error_model="numpy")
def sample(texels, skin, u, v, footprint_u, footprint_v):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN201
    """Luma and alpha (0..255) of a texture at (u, v) in 0..1, averaged over about one pixel's footprint."""
    offset, log_w, log_h = skin[0], skin[1], skin[2]
    width, height = 1 << log_w, 1 << log_h
    stride = 2 * width
    i, j = 0, 0
    spread = footprint_u * width
    while spread > 1.4 and i < log_w:
        spread *= 0.5
        i += 1
    spread = footprint_v * height
    while spread > 1.4 and j < log_h:
        spread *= 0.5
        j += 1
    w, h = width >> i, height >> j
    x = min(max(u * w - 0.5, 0.0), w - 1.0)
    y = min(max(v * h - 0.5, 0.0), h - 1.0)
    x0, y0 = int(x), int(y)
    fx, fy = x - x0, y - y0
    step_x = 1 if x0 < w - 1 else 0
    step_y = stride if y0 < h - 1 else 0
    at = offset + (2 * height - 2 * h + y0) * stride + (2 * width - 2 * w + x0)
    below = at + step_y
    a, b, c, d = (1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy
    luma = a * texels[at, 0] + b * texels[at + step_x, 0] + c * texels[below, 0] + d * texels[below + step_x, 0]
    alpha = a * texels[at, 1] + b * texels[at + step_x, 1] + c * texels[below, 1] + d * texels[below + step_x, 1]
    return luma, alpha
