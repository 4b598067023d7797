"""The band of an image that becomes the frame, so that images of any shape keep their aspect."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from jaxtyping import UInt8
from pydantic import BaseModel, ConfigDict, Field

from vprbench.errors import DataError
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH

__all__ = ["Crop"]


class Crop(BaseModel):
    """A band of rows over the whole width of an image.

    Attributes:
        top: the first row, pixels of the original image from 0; None: the band lies in the middle.
        rows: how many; None: as many as give the frame's shape, 642 : 188.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    top: Annotated[int, Field(ge=0)] | None = None
    rows: Annotated[int, Field(ge=1)] | None = None

    def band(self, image: UInt8[np.ndarray, "height width"], name: str) -> UInt8[np.ndarray, "rows width"]:
        """The band of an image; DataError, naming the image, where it is not that high."""
        height, width = image.shape
        rows = self.rows or round(width * FRAME_HEIGHT / FRAME_WIDTH)
        top = (height - rows) // 2 if self.top is None else self.top
        if top < 0 or top + rows > height:
            where = "in the middle" if self.top is None else f"from row {top} on"
            raise DataError(f"{name}: {width}x{height} pixels hold no band of {rows} rows {where}; change the crop")
        return image[top : top + rows]
