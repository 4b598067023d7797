"""Drawn houses: front, side, roof and gable of each model."""

from __future__ import annotations

import numpy as np

from vprbench.street.grain import Luma, fractal, opaque, rectangle
from vprbench.street.texture import Image

__all__ = ["paint_house"]

_SIZE = 256


def paint_house(rng: np.random.Generator) -> list[Image]:
    """Front, side, roof and gable of one model of house."""
    wall = rng.uniform(0.2, 0.8)
    plain = wall * (1 + 0.05 * fractal(rng, _SIZE, _SIZE))
    front, side = plain.copy(), plain.copy()
    if rng.random() < 0.3:
        _courses(front, rng)
    front *= np.linspace(1.05, 0.85, _SIZE, dtype=np.float32)[:, None]
    storeys, bays = int(rng.integers(2, 5)), int(rng.integers(2, 6))
    _windows(front, rng, storeys, bays)
    _ground_floor(front, rng, storeys, bays)
    _gable_end(side, rng)
    return [opaque(front), opaque(side), opaque(_roof(rng)), opaque(plain)]


def _gable_end(side: Luma, rng: np.random.Generator) -> None:
    """Streaks of weather, a plinth, a drain pipe, ivy, and a few windows."""
    streaks = np.repeat(fractal(rng, 1, _SIZE, 16), _SIZE, axis=0) * np.linspace(1, 0, _SIZE, dtype=np.float32)[:, None]
    side *= 1 + 0.06 * streaks
    rectangle(side, 0, _SIZE - rng.uniform(8, 24), _SIZE, _SIZE, rng.uniform(0.1, 0.3))
    if rng.random() < 0.5:
        rectangle(side, (left := rng.uniform(4, 240)), 0, left + 3, _SIZE, rng.uniform(0.1, 0.6))
    if rng.random() < 0.35:
        ivy = fractal(rng, _SIZE, _SIZE, 64) + np.linspace(-2.5, 1.5, _SIZE)[:, None]
        side[ivy > 0] = (0.06 * (1 + 0.5 * fractal(rng, _SIZE, _SIZE, 4)))[ivy > 0]
    size = rng.uniform(24, 40)
    for x, y in rng.permutation([(x, y) for x in (0.2, 0.45, 0.7) for y in (0.08, 0.38, 0.66)])[: rng.integers(0, 6)]:
        _window(side, rng, x * _SIZE, y * _SIZE, size, size * 1.2, 0.8)


def _courses(front: Luma, rng: np.random.Generator) -> None:
    """Brick or stone courses."""
    step = int(rng.integers(5, 12))
    front[::step] *= np.float32(rng.uniform(0.6, 0.85))


def _windows(front: Luma, rng: np.random.Generator, storeys: int, bays: int) -> None:
    """One row of windows a storey; a storey may have a balcony and a band below it."""
    high, wide = _SIZE / storeys, _SIZE / bays
    size_x, size_y = wide * rng.uniform(0.35, 0.6), high * rng.uniform(0.42, 0.62)
    frame, shutters = rng.uniform(0.5, 0.95), rng.random() < 0.35
    shutter = rng.uniform(0.08, 0.5)
    for storey in range(storeys):
        top = high * (storey + 0.22)
        for bay in range(bays):
            left = wide * (bay + 0.5) - size_x / 2
            if rng.random() < 0.06:
                continue
            _window(front, rng, left, top, size_x, size_y, frame)
            if shutters:
                rectangle(front, left - size_x * 0.45, top, left - 2, top + size_y, shutter)
                rectangle(front, left + size_x + 2, top, left + size_x * 1.45, top + size_y, shutter)
        if rng.random() < 0.3:
            rectangle(front, 0, high * (storey + 1) - 4, _SIZE, high * (storey + 1), frame)
    if storeys > 2 and rng.random() < 0.5:
        _balconies(front, rng, high, wide, bays, storeys)


def _window(
    luma: Luma, rng: np.random.Generator, left: float, top: float, wide: float, high: float, frame: float
) -> None:
    """Frame, dark glass, a curtain or blind of its own, a cross-bar and a sill with its shadow."""
    rectangle(luma, left - 3, top - 3, left + wide + 3, top + high + 3, frame)
    rectangle(luma, left, top, left + wide, top + high, rng.uniform(0.03, 0.12))
    if rng.random() < 0.5:
        rectangle(luma, left, top, left + wide, top + high * rng.uniform(0.15, 0.8), rng.uniform(0.2, 0.6))
    rectangle(luma, left + wide / 2 - 1, top, left + wide / 2 + 1, top + high, frame)
    rectangle(luma, left - 5, top + high + 3, left + wide + 5, top + high + 6, frame)
    rectangle(luma, left - 5, top + high + 6, left + wide + 5, top + high + 9, 0.12)


def _balconies(front: Luma, rng: np.random.Generator, high: float, wide: float, bays: int, storeys: int) -> None:
    bay, value = int(rng.integers(0, bays)), rng.uniform(0.2, 0.85)
    for storey in range(storeys - 1):
        bottom = high * (storey + 0.95)
        rectangle(front, wide * bay, bottom - high * 0.35, wide * (bay + 1), bottom, value)
        rectangle(front, wide * bay, bottom, wide * (bay + 1), bottom + 6, value * 0.3)
        if rng.random() < 0.7:
            front[round(bottom - high * 0.33) : round(bottom) - 2, round(wide * bay) : round(wide * (bay + 1)) : 4] *= (
                0.4
            )


def _ground_floor(front: Luma, rng: np.random.Generator, storeys: int, bays: int) -> None:
    """A door; a shop window, a gate or plain windows beside it; a plinth."""
    top, wide = _SIZE * (1 - 1 / storeys), _SIZE / bays
    kind = rng.choice(["plain", "shop", "garage"], p=[0.6, 0.2, 0.2])
    if kind == "shop":
        rectangle(front, 6, top + 8, _SIZE - 6, _SIZE, rng.uniform(0.15, 0.5))
        rectangle(front, 14, top + 30, _SIZE - 14, _SIZE - 14, rng.uniform(0.04, 0.15))
        _lettering(front, rng, top + 12)
    rectangle(front, 0, _SIZE - 12, _SIZE, _SIZE, rng.uniform(0.1, 0.3))
    if kind == "garage":
        left = wide * rng.integers(0, bays)
        rectangle(front, left + 4, top + 14, left + wide * 1.2, _SIZE, rng.uniform(0.15, 0.8))
        front[round(top) + 16 : _SIZE : 6, round(left) + 4 : round(left + wide * 1.2)] *= 0.7
    door = wide * (int(rng.integers(0, bays)) + 0.5) - 16
    rectangle(front, door - 4, top + 10, door + 36, _SIZE, rng.uniform(0.4, 0.9))
    rectangle(front, door, top + 14, door + 32, _SIZE, rng.uniform(0.05, 0.35))
    rectangle(front, door + 4, top + 18, door + 28, top + 36, 0.08)


def _lettering(front: Luma, rng: np.random.Generator, top: float) -> None:
    """Strokes that pass for a shop's name."""
    for letter in range(int(rng.integers(5, 10))):
        left = 28 + 20 * letter
        rectangle(front, left, top, left + 4, top + 14, 0.9)
        for _ in range(2):
            stroke = top + 5 * int(rng.integers(0, 3))
            rectangle(front, left, stroke, left + 12, stroke + 3, 0.9)


def _roof(rng: np.random.Generator) -> Luma:
    """Rows of tiles, a skylight or a dormer window."""
    roof = rng.uniform(0.1, 0.3) * (1 + 0.15 * fractal(rng, _SIZE, _SIZE, 8))
    roof[::6] *= 0.75
    for _ in range(int(rng.integers(0, 4))):
        left, top = rng.uniform(20, 200), rng.uniform(60, 150)
        rectangle(roof, left - 3, top - 3, left + 33, top + 50, 0.5)
        rectangle(roof, left, top, left + 30, top + 46, 0.06)
    return roof
