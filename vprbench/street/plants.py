"""Drawn trees, bushes and hedges."""

from __future__ import annotations

import cv2
import numpy as np

from vprbench.street.grain import Luma, fractal, opaque, with_alpha
from vprbench.street.texture import Image

__all__ = ["paint_bush", "paint_conifer", "paint_hedge", "paint_tree"]

_SIZE = 256


def paint_tree(rng: np.random.Generator) -> Image:
    """A broad-leaved tree; its crown fills the upper three quarters."""
    luma, alpha = _trunk(rng, 0.55, int(rng.integers(5, 9)))
    for _ in range(int(rng.integers(9, 15))):
        x, y = rng.uniform(0.26, 0.74) * _SIZE, rng.uniform(0.18, 0.58) * _SIZE
        _leaves(luma, alpha, rng, x, y, rng.uniform(0.12, 0.22) * _SIZE)
    return with_alpha(luma, alpha)


def paint_conifer(rng: np.random.Generator) -> Image:
    """A spruce or fir: tiers of branches, wider downwards."""
    luma, alpha = _trunk(rng, 0.85, 5)
    for y in np.linspace(0.04, 0.86, 16):
        reach = (0.04 + 0.4 * y) * _SIZE * rng.uniform(0.8, 1.1)
        for x in np.linspace(-1, 1, 5):
            _leaves(luma, alpha, rng, _SIZE / 2 + x * reach * 0.8, y * _SIZE + abs(x) * 8, 6 + reach * 0.25, 0.6)
    return with_alpha(luma, alpha)


def paint_bush(rng: np.random.Generator) -> Image:
    """A bush that fills its picture."""
    luma, alpha = np.zeros((_SIZE, _SIZE), np.float32), np.zeros((_SIZE, _SIZE), np.float32)
    for _ in range(12):
        x, y = rng.uniform(0.2, 0.8) * _SIZE, rng.uniform(0.35, 0.95) * _SIZE
        _leaves(luma, alpha, rng, x, y, rng.uniform(0.12, 0.22) * _SIZE)
    return with_alpha(luma, alpha)


def paint_hedge(rng: np.random.Generator) -> Image:
    """The side of a clipped hedge."""
    return opaque(0.1 * (1 + 0.45 * fractal(rng, 64, _SIZE, 4)) * np.linspace(1.3, 0.7, 64, dtype=np.float32)[:, None])


def _trunk(rng: np.random.Generator, top: float, half: int) -> tuple[Luma, Luma]:
    luma, alpha = np.zeros((_SIZE, _SIZE), np.float32), np.zeros((_SIZE, _SIZE), np.float32)
    middle = _SIZE // 2
    luma[:, middle - half : middle + half] = 0.1 * (1 + 0.2 * fractal(rng, _SIZE, 2 * half, 8))
    alpha[round(top * _SIZE) :, middle - half : middle + half] = 1.0
    return luma, alpha


def _leaves(
    luma: Luma, alpha: Luma, rng: np.random.Generator, x: float, y: float, radius: float, flat: float = 0.8
) -> None:
    """A clump of leaves: many dots, brighter on top, with gaps towards its rim."""
    for _ in range(round(radius * 5)):
        angle, distance = rng.uniform(0, 2 * np.pi), radius * np.sqrt(rng.uniform())
        dx, dy = distance * np.cos(angle), distance * np.sin(angle) * flat
        value = 0.1 - 0.05 * dy / radius + rng.uniform(-0.03, 0.05)
        centre = (round(x + dx), round(y + dy))
        size = int(rng.integers(2, 5))
        cv2.circle(luma, centre, size, float(value), -1)
        cv2.circle(alpha, centre, size, 1.0, -1)
