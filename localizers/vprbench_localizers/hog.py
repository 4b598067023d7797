"""Histograms of oriented gradients of 16 x 16 px cells, as CoHOG's public implementation computes them."""

from __future__ import annotations

from typing import Literal

import cv2
import numpy as np
from jaxtyping import Float64, UInt8
from numba import njit
from numpy.typing import NDArray

__all__ = ["Magnitude", "cell_histograms"]

# How strongly a pixel counts: |gx + gy| / 2, or the length of its gradient.
Magnitude = Literal["mean", "hypot"]

CELL = 16  # px a side
BINS = 8
BIN_WIDTH = 360.0 / BINS
# Rows done at a time: arrays of a whole image are so large that the system hands out fresh pages for each, which
# can take longer than the work itself.
STRIP = 64
HALO = 2  # rows that a 5 x 5 mask reaches beyond a pixel


def cell_histograms(
    image: UInt8[np.ndarray, "height width"], magnitude: Magnitude = "mean"
) -> Float64[np.ndarray, "rows columns 8"]:
    """The gradient strength in eight directions of 45 degrees, of each cell of an image.

    The image is first brightened to 255 sqrt(I / max I). A pixel's strength is split between the two directions
    nearest to its own, linearly. All is float64, as there, so that rounding falls as it does there.
    """
    shades = 255.0 * np.sqrt(np.arange(256) / max(int(image.max()), 1))
    bordered = cv2.copyMakeBorder(image, HALO, HALO, 0, 0, cv2.BORDER_REFLECT_101)
    strips = [bordered[top : top + STRIP + 2 * HALO] for top in range(0, len(image), STRIP)]
    return np.concatenate([_strip_histograms(strip, shades, magnitude) for strip in strips])


def _strip_histograms(
    strip: UInt8[np.ndarray, "height width"], shades: Float64[np.ndarray, "256"], magnitude: Magnitude
) -> Float64[np.ndarray, "rows columns 8"]:
    """The histograms of a strip of the image, given with the rows above and below that its gradients need."""
    shaded = cv2.LUT(strip, shades)
    gx = cv2.Sobel(shaded, cv2.CV_64F, 1, 0, ksize=5)[HALO:-HALO]
    gy = cv2.Sobel(shaded, cv2.CV_64F, 0, 1, ksize=5)[HALO:-HALO]
    strength = cv2.magnitude(gx, gy) if magnitude == "hypot" else cv2.addWeighted(gx, 0.5, gy, 0.5, 0.0)
    angle = cv2.phase(gx, gy, angleInDegrees=True)
    return _histograms(np.asarray(strength, np.float64), np.asarray(angle, np.float64))


@njit(cache=True)
def _histograms(strength: NDArray[np.float64], angle: NDArray[np.float64]) -> NDArray[np.float64]:
    height, width = angle.shape
    cells = np.zeros((height // CELL, width // CELL, BINS))
    for y in range(len(cells) * CELL):
        for x in range(cells.shape[1] * CELL):
            position = angle[y, x] / BIN_WIDTH
            whole = int(position)
            # cv2.phase can round up to 360 degrees, which counts for the last bin rather than the first.
            low = min(whole, BINS - 1)
            beyond = abs(strength[y, x]) * (position - whole)
            histogram = cells[y // CELL, x // CELL]
            histogram[low] += abs(strength[y, x]) - beyond
            histogram[(low + 1) % BINS] += beyond
    return cells
