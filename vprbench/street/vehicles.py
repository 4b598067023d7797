"""Drawn cars: the eight surfaces of each paint."""

from __future__ import annotations

import cv2
import numpy as np

from vprbench.street.grain import Luma, opaque, rectangle, with_alpha
from vprbench.street.texture import Image

__all__ = ["SURFACES", "paint_car"]

# Side, tail, nose, deck, side glass, glass, roof, and the shadow beneath.
SURFACES = 8


def paint_car(rng: np.random.Generator, paint: float) -> list[Image]:
    """The surfaces of a car of some reflectance, in the order that its mesh names them."""
    deck = np.full((64, 64), paint, np.float32)
    rectangle(deck, 0, 30, 64, 32, paint * 0.6)
    return [
        _side(paint),
        opaque(_tail(rng, paint)),
        opaque(_nose(rng, paint)),
        opaque(deck),
        opaque(_glass(paint, pillars=True)),
        opaque(_glass(paint, pillars=False)),
        opaque(np.full((16, 16), paint, np.float32)),
        _shadow(),
    ]


def _side(paint: float) -> Image:
    """Doors, sills and wheels; below the sill one sees through."""
    luma, alpha = np.full((64, 256), paint, np.float32), np.ones((64, 256), np.float32)
    alpha[50:] = 0.0
    luma[44:50] *= 0.4
    luma[:3] *= 0.7
    for x in (90, 150):
        luma[4:44, x : x + 2] *= 0.4
    for x in (50, 206):
        cv2.circle(luma, (x, 45), 21, 0.02, -1)
        cv2.circle(alpha, (x, 45), 18, 1.0, -1)
        cv2.circle(luma, (x, 45), 10, 0.35, -1)
        cv2.circle(luma, (x, 45), 4, 0.1, -1)
    return with_alpha(luma, alpha)


def _tail(rng: np.random.Generator, paint: float) -> Luma:
    luma = np.full((64, 128), paint, np.float32)
    rectangle(luma, 4, 10, 24, 24, 0.12)
    rectangle(luma, 104, 10, 124, 24, 0.12)
    rectangle(luma, 44, 22, 84, 34, 0.8)
    for x in range(48, 80, 6):
        rectangle(luma, x, 24, x + int(rng.integers(2, 5)), 32, 0.1)
    rectangle(luma, 0, 42, 128, 44, paint * 0.4)
    rectangle(luma, 0, 54, 128, 64, 0.05)
    return luma


def _nose(rng: np.random.Generator, paint: float) -> Luma:
    luma = _tail(rng, paint)
    rectangle(luma, 4, 10, 30, 24, 0.9)
    rectangle(luma, 98, 10, 124, 24, 0.9)
    rectangle(luma, 34, 8, 94, 20, 0.05)
    return luma


def _glass(paint: float, *, pillars: bool) -> Luma:
    luma = np.full((32, 64), 0.04, np.float32)
    luma += np.linspace(0.12, 0.0, 32, dtype=np.float32)[:, None]
    luma[:3], luma[29:] = paint * 0.8, paint * 0.8
    for x in (0, 30, 60) if pillars else (0, 61):
        luma[:, x : x + 3] = paint * 0.8
    return luma


def _shadow() -> Image:
    """Dark in the middle, fading over its rim."""
    y, x = np.mgrid[-1:1:64j, -1:1:64j]
    rim = np.maximum(np.abs(x), np.abs(y))
    return with_alpha(np.zeros((64, 64), np.float32), np.clip((1.0 - rim) * 5, 0.0, 0.85).astype(np.float32))
