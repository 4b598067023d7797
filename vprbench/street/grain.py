"""Random grain for surfaces: fractal noise, and the empty images on which textures are painted."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32

from vprbench.street.texture import Image

__all__ = ["Luma", "fractal", "opaque", "rectangle", "with_alpha"]

# Reflectance 0..1 of a surface.
Luma = Float32[np.ndarray, "height width"]


def fractal(rng: np.random.Generator, height: int, width: int, coarsest: int = 32) -> Luma:
    """Noise about 0 with standard deviation near 1 and equal power in every octave up to `coarsest` texels."""
    total = np.zeros((height, width), np.float32)
    scale, octaves = 1, 0
    while scale <= coarsest:
        grid = rng.standard_normal((max(1, height // scale), max(1, width // scale)), np.float32)
        total += _stretch(_stretch(grid, height, axis=0), width, axis=1)
        scale, octaves = scale * 2, octaves + 1
    return total / np.float32(np.sqrt(octaves))


def _stretch(grid: Luma, size: int, axis: int) -> Luma:
    """The grid as long as `size` on one axis, linear between its values.

    It is the same on every machine, which cv2.resize does not promise.
    """
    length = grid.shape[axis]
    if length == size:
        return grid
    at = np.clip((np.arange(size) + 0.5) * length / size - 0.5, 0, length - 1)
    low = at.astype(np.int64)
    part = np.expand_dims((at - low).astype(np.float32), 1 - axis)
    return grid.take(low, axis) * (1 - part) + grid.take(np.minimum(low + 1, length - 1), axis) * part


def rectangle(luma: Luma, left: float, top: float, right: float, bottom: float, value: float) -> None:
    """Fill a rectangle given in texels."""
    luma[max(0, round(top)) : max(0, round(bottom)), max(0, round(left)) : max(0, round(right))] = value


def opaque(luma: Luma) -> Image:
    """A texture without holes."""
    return with_alpha(luma, np.ones_like(luma))


def with_alpha(luma: Luma, alpha: Luma) -> Image:
    """A texture with holes."""
    return np.stack([np.clip(luma, 0.0, 1.0) * alpha, alpha], axis=-1).astype(np.float32)
