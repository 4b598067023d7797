"""How much memory an object holds."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterable
from types import BuiltinFunctionType, FunctionType, ModuleType

import numpy as np

__all__ = ["held_bytes"]

# What is there once, however many objects refer to it.
_SHARED = type, ModuleType, FunctionType, BuiltinFunctionType


def held_bytes(thing: object, without: Iterable[object] = ()) -> int:
    """Bytes of an object and of all that it refers to, but for what is left out: arrays with what they keep free.

    Memory that is reserved in advance counts, though some systems lend it only when it is used.
    """
    seen, left, total = {id(other) for other in without}, [thing], 0
    while left:
        found = left.pop()
        # A view holds what it is a view of.
        if isinstance(found, np.ndarray) and isinstance(found.base, np.ndarray):
            found = found.base
        if id(found) in seen or isinstance(found, _SHARED):
            continue
        seen.add(id(found))
        total += sys.getsizeof(found)
        if isinstance(found, np.ndarray) and found.base is not None and id(found.base) not in seen:
            # The values belong to something that numpy does not know the size of, such as what numba returns.
            seen.add(id(found.base))
            total += found.nbytes
        left += gc.get_referents(found)
    return total
