"""Local Shannon entropy: how many bits the grey values around each pixel hold."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float64, UInt8
from numba import njit
from numpy.typing import NDArray

__all__ = ["local_entropy", "region_entropy"]

SIDE = 512  # px, of the image that the regions divide
REGION = 32  # px a side
STRIDE = 16  # px from one region to the next
MAP_SIDE = 100  # px, of the smaller image that the entropy is taken of
GREY_BITS = 8


def _region_means() -> Float64[np.ndarray, "31 100"]:
    """What each row of the entropy map adds to each row of regions, once the map is enlarged to the image."""
    enlarged = cv2.resize(np.eye(MAP_SIDE), (MAP_SIDE, SIDE), interpolation=cv2.INTER_LINEAR)
    starts = range(0, SIDE - REGION + 1, STRIDE)
    return np.stack([enlarged[start : start + REGION].mean(axis=0) for start in starts])


REGION_MEANS = _region_means()


def region_entropy(image: UInt8[np.ndarray, "512 512"]) -> Float64[np.ndarray, "31 31"]:
    """How much of the 8 bits of a grey value the neighbourhoods in each region of 32 x 32 px hold, 0..1.

    It is the mean over the region of the local entropy of the image at 100 x 100 px, enlarged again: enlarging and
    averaging are both linear, so two small matrix products do both at once.
    """
    small = cv2.resize(image, (MAP_SIDE, MAP_SIDE), interpolation=cv2.INTER_LINEAR)
    means: Float64[np.ndarray, "31 31"] = REGION_MEANS @ local_entropy(small) @ REGION_MEANS.T
    return means / GREY_BITS


def local_entropy(image: UInt8[np.ndarray, "height width"], radius: int = 5) -> Float64[np.ndarray, "height width"]:
    """Entropy, in bits, of the grey values within `radius` px of each pixel; outside the image there are none.

    With p the shares of the n pixels and c = n p their counts, -sum p log2 p = (n log2 n - sum c log2 c) / n.
    """
    rows = np.arange(-radius, radius + 1)
    reach = np.sqrt(radius**2 - rows**2).astype(np.int64)
    counts = np.arange(np.sum(2 * reach + 1) + 1, dtype=np.float64)
    bits = counts * np.log2(np.maximum(counts, 1.0))
    # In multiples of 2^-40 every sum is exact, so that the sliding sum gathers no rounding.
    return _slide(image, reach, np.round(bits * 2.0**40) / 2.0**40)


@njit(cache=True)
def _slide(image: NDArray[np.uint8], reach: NDArray[np.int64], bits: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slide the disk along each row; pixels leave its histogram on the left and enter it on the right."""
    height, width = image.shape
    radius = len(reach) // 2
    entropy = np.empty((height, width))
    for y in range(height):
        first, end = max(y - radius, 0), min(y + radius + 1, height)
        count = np.zeros(256, np.int64)
        pixels, total = 0, 0.0
        for x in range(-radius, width):
            for row in range(first, end):
                leaving = x - reach[row - y + radius] - 1
                entering = x + reach[row - y + radius]
                # Leaving comes first: no count is ever above the disk's area, where `bits` ends.
                if leaving >= 0:
                    grey = image[row, leaving]
                    total += bits[count[grey] - 1] - bits[count[grey]]
                    count[grey] -= 1
                    pixels -= 1
                if 0 <= entering < width:
                    grey = image[row, entering]
                    total += bits[count[grey] + 1] - bits[count[grey]]
                    count[grey] += 1
                    pixels += 1
            if x >= 0:
                entropy[y, x] = (bits[pixels] - total) / pixels
    return entropy
