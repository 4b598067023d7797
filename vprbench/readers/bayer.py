"""Grey images of a sensor with a Bayer filter, which saw one colour at each pixel."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import cv2
import numpy as np
from jaxtyping import UInt8

from vprbench.errors import DataError

__all__ = ["Bayer", "demosaiced", "is_colour"]

# The colours of the first two rows' first two pixels, row by row.
Bayer = Literal["bggr", "gbrg", "grbg", "rggb"]

_CODES: dict[Bayer, int] = {
    "bggr": cv2.COLOR_BayerBGGR2GRAY,
    "gbrg": cv2.COLOR_BayerGBRG2GRAY,
    "grbg": cv2.COLOR_BayerGRBG2GRAY,
    "rggb": cv2.COLOR_BayerRGGB2GRAY,
}


def demosaiced(raw: UInt8[np.ndarray, "height width"], pattern: Bayer) -> UInt8[np.ndarray, "height width"]:
    """The luma (0.299 R + 0.587 G + 0.114 B) of a raw image, its missing colours interpolated bilinearly by OpenCV."""
    return np.asarray(cv2.cvtColor(raw, _CODES[pattern]), np.uint8)


def is_colour(path: Path) -> bool:
    """Whether an image file holds colours rather than one value a pixel."""
    image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    if image is None:
        raise DataError(f"{path}: the image cannot be decoded; fetch the file again")
    return image.ndim > 2
