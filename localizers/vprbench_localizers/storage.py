"""How Max-Pi keeps signatures: as the encoder gives them, or as one byte a value."""

from __future__ import annotations

from typing import Literal

import numpy as np
from jaxtyping import Float32, UInt8

from vprbench.errors import PluginError
from vprbench.protocols import Encoder

__all__ = ["Storage", "can_store", "in_bytes"]

Storage = Literal["float32", "uint8"]

# Steps from 0 to 1.
STEPS = 255


def can_store(storage: str, encoder: Encoder) -> bool:
    """Whether an encoder's signatures can be kept so; the lists of what codes share hold no bytes."""
    if storage == "float32":
        return True
    return getattr(encoder, "matches_bytes", False) and not getattr(encoder, "matches_by_overlap", False)


def in_bytes(signatures: Float32[np.ndarray, "points size"]) -> UInt8[np.ndarray, "points size"]:
    """Signatures of values in 0..1 in 255ths of 1: the nearest, so that no value is off by more than 1/510.

    Raises:
        PluginError: a value is not in 0..1.
    """
    steps = np.rint(np.float32(STEPS) * signatures)
    if not (np.min(steps, initial=0) >= 0 and np.max(steps, initial=0) <= STEPS):
        raise PluginError("the encoder says that it matches bytes, but gives signatures of values that are not in 0..1")
    return steps.astype(np.uint8)
