"""Drawn trees, bushes and hedges: clumps of leaves, each bright above and dark below."""

from __future__ import annotations

import numpy as np

from vprbench.street.grain import Luma, fractal, opaque, with_alpha
from vprbench.street.texture import Image

__all__ = ["paint_bush", "paint_conifer", "paint_hedge", "paint_tree"]

_SIZE = 256

Clump = tuple[float, float, float, float]  # centre, radius across and radius up, in parts of the picture


def paint_tree(rng: np.random.Generator) -> Image:
    """A broad-leaved tree; its crown fills the upper three quarters."""
    clumps = []
    for _ in range(int(rng.integers(10, 16))):
        angle, reach = rng.uniform(0, 2 * np.pi), 0.24 * np.sqrt(rng.uniform())
        radius = rng.uniform(0.11, 0.2)
        clumps.append((0.5 + reach * np.cos(angle), 0.4 + reach * np.sin(angle), radius, radius * 0.75))
    return _with_trunk(rng, _leaves(rng, clumps), 0.5, int(rng.integers(5, 9)))


def paint_conifer(rng: np.random.Generator) -> Image:
    """A spruce or fir: tiers of drooping branches, wider downwards."""
    clumps = []
    for up in np.linspace(0.05, 0.86, 11):
        reach = (0.04 + 0.38 * up) * rng.uniform(0.8, 1.1)
        for x in (-0.75, -0.25, 0.25, 0.75):
            clumps.append((0.5 + x * reach, up + abs(x) * 0.05, 0.03 + reach * 0.35, 0.05))
    return _with_trunk(rng, _leaves(rng, clumps), 0.85, 5)


def paint_bush(rng: np.random.Generator) -> Image:
    """A bush that stands on the ground and fills its picture."""
    clumps = [(rng.uniform(0.2, 0.8), rng.uniform(0.35, 0.9), r, r) for r in rng.uniform(0.12, 0.22, 12)]
    return with_alpha(*_leaves(rng, clumps))


def paint_hedge(rng: np.random.Generator) -> Image:
    """The side of a clipped hedge."""
    return opaque(0.09 * (1 + 0.45 * fractal(rng, 64, _SIZE, 4)) * np.linspace(1.3, 0.6, 64, dtype=np.float32)[:, None])


def _leaves(rng: np.random.Generator, clumps: list[Clump]) -> tuple[Luma, Luma]:
    """Luma and alpha of clumps of leaves, frayed at their rims."""
    x = (np.arange(_SIZE) + 0.5) / _SIZE
    y = x[:, None]
    depth, light = np.full((_SIZE, _SIZE), -9.0), np.zeros((_SIZE, _SIZE))
    for cx, cy, rx, ry in clumps:
        here = 1.0 - ((x - cx) / rx) ** 2 - ((y - cy) / ry) ** 2
        light = np.where(here > depth, rng.uniform(0.7, 1.2) - 0.5 * (y - cy) / ry, light)
        depth = np.maximum(depth, here)
    leaf = fractal(rng, _SIZE, _SIZE, 8)
    alpha = np.clip((depth + 0.45 * leaf) * 3.0 + 0.3, 0.0, 1.0)
    luma = 0.085 * np.maximum(light, 0.15) * (1 + 0.4 * fractal(rng, _SIZE, _SIZE, 4))
    return luma.astype(np.float32), alpha.astype(np.float32)


def _with_trunk(rng: np.random.Generator, leaves: tuple[Luma, Luma], top: float, half: int) -> Image:
    """Leaves before a trunk that is some texels half-wide and goes up behind them."""
    luma, alpha = leaves
    rows, columns = slice(round(top * _SIZE), _SIZE), slice(_SIZE // 2 - half, _SIZE // 2 + half)
    bark = 0.1 * (1 + 0.2 * fractal(rng, _SIZE, 2 * half, 8))[rows]
    gaps = alpha[rows, columns]
    luma[rows, columns] = luma[rows, columns] * gaps + bark * (1 - gaps)
    alpha[rows, columns] = 1.0
    return with_alpha(luma, alpha)
