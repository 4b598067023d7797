"""Landmarks as short vectors, whose product falls as their looks or their directions part."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int64
from numba import njit
from numpy.typing import NDArray

from vprbench_localizers.unit_activity import View

__all__ = ["FOLDED", "Fold", "fold_of", "landmark_vectors"]

# Values that are left of a signature (our choice): with two for the azimuth, at a byte each, a line of the cache.
FOLDED = 62


class Fold(NamedTuple):
    """Where in its vector each value of a signature is added, and with which sign.

    Shapes:
        positions: int64 (size,), 0..61.
        signs: float32 (size,), 1 or -1.
    """

    positions: Int64[np.ndarray, " size"]
    signs: Float32[np.ndarray, " size"]


def fold_of(size: int) -> Fold:
    """That of signatures of so many values: none if they fit, else feature hashing (K. Weinberger et al., 2009).

    Each value is added to one of 62, or taken from it, by chance, always the same for the same size: the products of
    vectors then are right on average.
    """
    if size <= FOLDED:
        return Fold(np.arange(size), np.ones(size, np.float32))
    random = np.random.default_rng(0)
    signs = 2 * random.integers(2, size=size) - 1
    return Fold(random.permutation(np.arange(size) % FOLDED), signs.astype(np.float32))


def landmark_vectors(view: View, fold: Fold, azimuth_weight: float) -> Float32[np.ndarray, "points 64"]:
    """Roots of the signature's values at unit length, folded, then the azimuth on a circle of so large a radius."""
    vectors = np.zeros((len(view.azimuths), FOLDED + 2), np.float32)
    _add_folded(vectors, view.signatures, *fold)
    vectors[:, FOLDED] = azimuth_weight * np.cos(view.azimuths)
    vectors[:, FOLDED + 1] = azimuth_weight * np.sin(view.azimuths)
    return vectors


@njit(cache=True)
def _add_folded(
    vectors: NDArray[np.float32],
    signatures: NDArray[np.float32],
    positions: NDArray[np.int64],
    signs: NDArray[np.float32],
) -> None:
    for row in range(len(signatures)):
        # The squares of the roots add up to it.
        total = np.abs(signatures[row]).sum()
        for i in range(signatures.shape[1]):
            value = signatures[row, i]
            if value != 0:
                vectors[row, positions[i]] += signs[i] * np.sign(value) * np.sqrt(abs(value) / total)
