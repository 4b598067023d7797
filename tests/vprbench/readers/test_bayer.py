"""Bayer mosaics laid by hand, whose colours are known."""

from __future__ import annotations

from typing import get_args

import cv2
import numpy as np
import pytest

from vprbench.readers.bayer import Bayer, demosaiced

COLOURS = {"r": 200, "g": 100, "b": 50}
LUMA = round(0.299 * 200 + 0.587 * 100 + 0.114 * 50)


def mosaic(pattern: str, channels: dict[str, np.ndarray]) -> np.ndarray:
    """What a sensor sees through a filter of this pattern."""
    raw = np.empty_like(channels["g"])
    for place, colour in enumerate(pattern):
        row, column = divmod(place, 2)
        raw[row::2, column::2] = channels[colour][row::2, column::2]
    return raw


@pytest.mark.parametrize("pattern", get_args(Bayer))
def test_one_colour_has_one_luma(pattern: Bayer) -> None:
    raw = mosaic(pattern, {name: np.full((20, 30), value, np.uint8) for name, value in COLOURS.items()})
    assert np.abs(demosaiced(raw, pattern)[2:-2, 2:-2].astype(int) - LUMA).max() <= 1


def test_another_pattern_gives_another_luma() -> None:
    raw = mosaic("rggb", {name: np.full((20, 30), value, np.uint8) for name, value in COLOURS.items()})
    for pattern in ("bggr", "gbrg", "grbg"):
        assert np.abs(demosaiced(raw, pattern)[2:-2, 2:-2].astype(int) - LUMA).mean() > 5


@pytest.mark.parametrize("pattern", get_args(Bayer))
def test_a_smooth_picture_comes_back(pattern: Bayer) -> None:
    y, x = np.mgrid[:40, :60]
    channels = {"r": 2 * x + y, "g": 200 - x - y, "b": 3 * y}
    picture = {name: values.astype(np.uint8) for name, values in channels.items()}
    grey = cv2.cvtColor(np.dstack([picture["r"], picture["g"], picture["b"]]), cv2.COLOR_RGB2GRAY)
    inside = (slice(2, -2), slice(2, -2))
    assert np.abs(demosaiced(mosaic(pattern, picture), pattern)[inside].astype(int) - grey[inside]).max() <= 2
