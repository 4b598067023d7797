"""A NumPy file of Python objects read without trusting it: what it pickles can be numbers, lists and arrays alone.

`numpy.load(allow_pickle=True)` runs whatever code a file names. Here every name outside a short list is refused before
anything is made of it; what is on the list makes data and calls nothing.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.lib import format as npy

from vprbench.errors import DataError

__all__ = ["read_objects"]


def _bytes(text: str, coding: str) -> bytes:
    """Bytes, as the pickles of Python 2 spell them."""
    if coding != "latin1":
        raise pickle.UnpicklingError(f"bytes in {coding!r}")
    return text.encode(coding)


# The functions by which NumPy makes an array, or a single number, again.
_ARRAY: Any = np.zeros(0).__reduce__()[0]
_NUMBER: Any = np.int64(0).__reduce__()[0]

# How NumPy 1 and 2 pickle arrays and single numbers, and how Python 2 and 3 pickle a range.
_ADMITTED: dict[tuple[str, str], Callable[..., object]] = {
    **{(f"numpy.{core}.multiarray", "_reconstruct"): _ARRAY for core in ("core", "_core")},
    **{(f"numpy.{core}.multiarray", "scalar"): _NUMBER for core in ("core", "_core")},
    ("numpy", "ndarray"): np.ndarray,
    ("numpy", "dtype"): np.dtype,
    ("builtins", "range"): range,
    ("__builtin__", "xrange"): range,
    ("_codecs", "encode"): _bytes,
}


class _Unpickler(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Callable[..., object]:
        """What a pickle may call, by name."""
        try:
            return _ADMITTED[module, name]
        except KeyError as error:
            raise pickle.UnpicklingError(f"it would run {module}.{name}, which is no data") from error


def read_objects(path: Path) -> np.ndarray:
    """The array in a .npy file, of objects or of numbers.

    Raises:
        DataError: the file cannot be read, is no .npy file, or names anything but numbers, lists and arrays.
    """
    try:
        with path.open("rb") as file:
            return _read(file)
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror})") from error
    except Exception as error:  # a damaged pickle may raise anything
        reason = str(error).split("\n")[0] or type(error).__name__
        raise DataError(
            f"{path}: not readable as an array of lists ({reason}); get the file anew from its authors"
        ) from error


def _read(file: BinaryIO) -> np.ndarray:
    version = npy.read_magic(file)
    header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
    _, _, dtype = header(file)
    if not dtype.hasobject:
        file.seek(0)
        return np.asarray(npy.read_array(file, allow_pickle=False))
    # Python 2 wrote bytes as text.
    return np.asarray(_Unpickler(file, encoding="latin1").load(), object)
