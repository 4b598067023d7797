"""Where a vehicle was, frame by frame."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

__all__ = ["Motion"]


class Motion(NamedTuple):
    """Where a vehicle was at each frame: (n, 2) metres, (n,) radians clockwise from north, (n,) seconds."""

    positions: Float64[np.ndarray, "n 2"]
    headings: Float64[np.ndarray, " n"]
    times: Float64[np.ndarray, " n"]
