"""Arrays that grow at their end, and begin where a line of the cache does.

Elsewhere every other load of 32 bytes would touch two lines.
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

__all__ = ["Growing", "with_room"]

Kind = TypeVar("Kind", bound=np.generic)

# Bytes in a line of the cache.
LINE = 64


def with_room(array: NDArray[Kind], rows: int, used: int) -> NDArray[Kind]:
    """The array itself if it has room for so many rows, else one for twice as many that begins with its `used` rows.

    Doubling makes all the copies together cost less than two writes a row, however many rows there come to be. What
    is not used takes address space only, until it is.
    """
    if rows <= len(array):
        return array
    larger = _aligned(array.dtype, 2 * rows, *array.shape[1:])
    larger[:used] = array[:used]
    return larger


class Growing:
    """Rows in one contiguous array; adding one costs the same however many there are.

    Args:
        dtype: of the values.
        shape: of one row.
    """

    def __init__(self, dtype: DTypeLike, *shape: int) -> None:
        self._count = 0
        self._store = _aligned(np.dtype(dtype), 8, *shape)

    @property
    def rows(self) -> NDArray[Any]:
        """All rows; a view that the next `extend` may leave behind."""
        return self._store[: self._count]

    def __len__(self) -> int:
        return self._count

    def extend(self, rows: NDArray[Any]) -> None:
        """Add these rows at the end."""
        end = self._count + len(rows)
        self._store = with_room(self._store, end, self._count)
        self._store[self._count : end] = rows
        self._count = end


def _aligned(dtype: np.dtype[Any], *shape: int) -> NDArray[Any]:
    size = int(np.prod(shape)) * dtype.itemsize
    raw = np.empty(size + LINE, np.uint8)
    first = -raw.ctypes.data % LINE
    return raw[first : first + size].view(dtype).reshape(shape)
