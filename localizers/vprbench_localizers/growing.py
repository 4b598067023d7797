"""Arrays that grow at their end."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

__all__ = ["with_room"]

Kind = TypeVar("Kind", bound=np.generic)


def with_room(array: NDArray[Kind], rows: int, used: int) -> NDArray[Kind]:
    """The array itself if it has room for so many rows, else one for twice as many that begins with its `used` rows.

    Doubling makes all the copies together cost less than two writes a row, however many rows there come to be. What
    is not used takes address space only, until it is.
    """
    if rows <= len(array):
        return array
    larger: NDArray[Any] = np.empty((2 * rows, *array.shape[1:]), array.dtype)
    larger[:used] = array[:used]
    return larger
