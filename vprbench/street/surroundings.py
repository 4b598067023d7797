"""Drawn ground, sky, lamp posts and signs."""

from __future__ import annotations

import cv2
import numpy as np

from vprbench.street.grain import fractal, opaque, rectangle, with_alpha
from vprbench.street.ground import GROUND_HALF, GROUND_PERIOD, GROUND_ROAD
from vprbench.street.parameters import Environment
from vprbench.street.texture import Image

__all__ = ["paint_ground_strip", "paint_lamp", "paint_mark", "paint_sign", "paint_sky_round"]

_ACROSS, _ALONG = 512, 1024


def paint_ground_strip(rng: np.random.Generator, environment: Environment) -> Image:
    """Road, kerbs, pavements and what lies beyond; along the street in columns, across it in rows."""
    lateral = (np.arange(_ACROSS) + 0.5) / _ACROSS * 2 * GROUND_HALF - GROUND_HALF
    grain = fractal(rng, _ACROSS, _ALONG, 16)
    base = np.where(np.abs(lateral) < GROUND_ROAD, 0.16, 0.3)
    base = np.where(np.abs(lateral) > GROUND_ROAD + 2.2, 0.12, base).astype(np.float32)
    ground = base[:, None] * (1 + 0.12 * grain)
    scale = _ALONG / GROUND_PERIOD
    pavement = (np.abs(lateral) > GROUND_ROAD + 0.2) & (np.abs(lateral) < GROUND_ROAD + 2.2)
    ground[np.ix_(pavement, np.arange(0, _ALONG, round(scale)))] *= 0.7
    kerb = np.abs(np.abs(lateral) - GROUND_ROAD - 0.08) < 0.09
    ground[kerb] = 0.5
    gutter = np.abs(np.abs(lateral) - GROUND_ROAD + 0.15) < 0.12
    ground[gutter] *= 0.7
    for _ in range(10):
        x, y = rng.uniform(0, _ALONG), rng.uniform(-GROUND_ROAD, GROUND_ROAD)
        row = (y + GROUND_HALF) / (2 * GROUND_HALF) * _ACROSS
        patch = slice(round(row), round(row + rng.uniform(8, 30))), slice(round(x), round(x + rng.uniform(10, 80)))
        ground[patch] *= rng.uniform(0.6, 1.2)
    if environment != "narrow":
        for x in np.arange(0, _ALONG, _ALONG / 8):
            rectangle(ground, x, _ACROSS / 2 - 1, x + 3 * scale, _ACROSS / 2 + 1, 0.6)
    return opaque(ground)


def paint_mark(rng: np.random.Generator) -> Image:
    """A patch, a manhole cover or a crack in the road."""
    luma, alpha = np.full((64, 64), 0.08, np.float32), np.zeros((64, 64), np.float32)
    kind = rng.integers(0, 3)
    if kind == 0:
        alpha[4:60, 4:60] = 0.6
        luma += 0.03 * fractal(rng, 64, 64, 8)
    elif kind == 1:
        cv2.circle(alpha, (32, 32), 28, 1.0, -1)
        luma[::6] = 0.2
    else:
        points = np.stack([np.linspace(0, 64, 12), 32 + np.cumsum(rng.normal(0, 5, 12))], -1).astype(np.int32)
        cv2.polylines(alpha, [points], False, 0.8, 2)
    return with_alpha(luma, alpha)


def paint_lamp(rng: np.random.Generator) -> Image:
    """A lamp post."""
    luma, alpha = np.full((256, 64), rng.uniform(0.1, 0.35), np.float32), np.zeros((256, 64), np.float32)
    rectangle(alpha, 30, 8, 34, 256, 1.0)
    rectangle(alpha, 29, 170, 35, 256, 1.0)
    rectangle(alpha, 32, 4, 60, 10, 1.0)
    return with_alpha(luma, alpha)


def paint_sign(rng: np.random.Generator) -> Image:
    """A traffic sign of some shape upon its pole."""
    luma, alpha = np.full((256, 64), 0.3, np.float32), np.zeros((256, 64), np.float32)
    rectangle(alpha, 30, 40, 34, 256, 1.0)
    shape = rng.integers(0, 3)
    rim, plate = rng.uniform(0.1, 0.3), rng.uniform(0.5, 0.9)
    if shape == 0:
        for radius, value in ((30, rim), (22, plate)):
            cv2.circle(luma, (32, 32), radius, value, -1)
        cv2.circle(alpha, (32, 32), 30, 1.0, -1)
    elif shape == 1:
        cv2.fillConvexPoly(luma, np.array([(32, 2), (62, 58), (2, 58)]), rim)
        cv2.fillConvexPoly(luma, np.array([(32, 16), (52, 52), (12, 52)]), plate)
        cv2.fillConvexPoly(alpha, np.array([(32, 2), (62, 58), (2, 58)]), 1.0)
    else:
        rectangle(luma, 6, 2, 58, 60, plate)
        rectangle(luma, 12, 8, 52, 54, rim)
        rectangle(alpha, 6, 2, 58, 60, 1.0)
    cv2.line(luma, (20, 32), (44, 32), float(rng.uniform(0, 1)), 5)
    return with_alpha(luma, alpha)


def paint_sky_round(rng: np.random.Generator) -> Image:
    """The sky all round: bright, with clouds, paler towards the horizon and distant trees upon it."""
    clouds = fractal(rng, 128, 1024, 64)
    clouds[:, :256] = clouds[:, :256] * np.linspace(0, 1, 256) + clouds[:, -1:] * np.linspace(1, 0, 256)
    height = np.linspace(1.0, 0.0, 128, dtype=np.float32)[:, None]
    sky = 0.8 - 0.35 * height + 0.12 * np.clip(clouds, -1, 2)
    skyline = 0.04 + 0.015 * fractal(rng, 1, 1024, 64)
    sky = np.where(height < skyline, 0.05, sky)
    return opaque(sky.astype(np.float32))
