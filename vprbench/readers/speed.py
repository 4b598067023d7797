"""Steps that no road vehicle makes: a lost fix, or a wrong unit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float64

from vprbench.errors import DataError

__all__ = ["check_speed"]

# Metres a second. Faster than any road vehicle. Our choice.
_FASTEST = 100.0


def check_speed(
    positions: Float64[np.ndarray, "n 2"], times: Float64[np.ndarray, " n"], where: Callable[[int], str]
) -> None:
    """Refuse a step between two frames that no road vehicle makes; `where` names the file and line of frame i.

    Args:
        positions: (n, 2) metres.
        times: (n,) seconds, increasing.
        where: for the message.
    """
    speeds = np.linalg.norm(np.diff(positions, axis=0), axis=1) / np.diff(times)
    bad = np.flatnonzero(speeds > _FASTEST)
    if bad.size:
        place, speed = where(int(bad[0]) + 1), speeds[bad[0]]
        raise DataError(f"{place}: {speed:.0f} m/s since the frame before; check the position and the time (s)")
