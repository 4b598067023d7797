"""An array that grows row by row."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

__all__ = ["Growing"]

# Bytes in a line of the cache.
LINE = 64


class Growing:
    """Rows in one contiguous array; adding one costs the same however many there are.

    The array begins where a line of the cache does: elsewhere every other load of 32 bytes would touch two lines.

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
        if end > len(self._store):
            # Doubling makes all the copies together cost less than two writes a row.
            grown = _aligned(self._store.dtype, max(2 * len(self._store), end), *self._store.shape[1:])
            grown[: self._count] = self.rows
            self._store = grown
        self._store[self._count : end] = rows
        self._count = end


def _aligned(dtype: np.dtype[Any], *shape: int) -> NDArray[Any]:
    size = int(np.prod(shape)) * dtype.itemsize
    raw = np.empty(size + LINE, np.uint8)
    first = -raw.ctypes.data % LINE
    return raw[first : first + size].view(dtype).reshape(shape)
