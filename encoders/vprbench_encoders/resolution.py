"""Images at a part of their resolution."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["reduced"]


def reduced(image: NDArray[np.uint8] | NDArray[np.float32], by: int) -> NDArray[Any]:
    """The image at 1/by of its resolution, each pixel the mean of by x by; rows and columns left over are cut off."""
    rows, columns = (side // by for side in image.shape)
    return cv2.resize(image[: rows * by, : columns * by], (columns, rows), interpolation=cv2.INTER_AREA)
