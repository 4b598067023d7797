"""Hebb's rule for sparse codes: every atom is pulled towards what is left unexplained of the signals that use it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32
from numba import njit
from numpy.typing import NDArray

from vprbench_encoders.matching_pursuit import SparseCode

__all__ = ["HebbianSums", "hebbian_sums"]


class HebbianSums(NamedTuple):
    """What a batch says of a dictionary.

    Attributes:
        pull: (atoms, size), sum over its signals of a_i (I - Phi a), for each atom.
        energy: (atoms,), sum of a_i^2.
        rate: its reconstruction rate.
    """

    pull: Float32[np.ndarray, "atoms size"]
    energy: Float32[np.ndarray, " atoms"]
    rate: float


def hebbian_sums(
    signals: Float32[np.ndarray, "samples size"], dictionary: Float32[np.ndarray, "atoms size"], code: SparseCode
) -> HebbianSums:
    """What a batch of signals and their codes say of a dictionary; the rate is `reconstruction_rate`."""
    pull, energy = np.zeros_like(dictionary), np.zeros(len(dictionary), np.float32)
    explained, count = _accumulate(signals, dictionary, *code, pull, energy)
    return HebbianSums(pull, energy, explained / count if count else float("nan"))


@njit(cache=True, fastmath=True)
def _accumulate(
    signals: NDArray[np.float32],
    dictionary: NDArray[np.float32],
    atoms: NDArray[np.int32],
    values: NDArray[np.float32],
    pull: NDArray[np.float32],
    energy: NDArray[np.float32],
) -> tuple[float, int]:
    """Add to the sums; what the codes explain of all signals' energies, each as a share, and how many have any."""
    left = np.empty(signals.shape[1], np.float32)
    explained, count = 0.0, 0
    for sample in range(len(signals)):
        left[:] = signals[sample]
        for slot in range(atoms.shape[1]):
            atom, value = dictionary[atoms[sample, slot]], values[sample, slot]
            for i in range(len(left)):
                left[i] -= value * atom[i]
        for slot in range(atoms.shape[1]):
            target, value = atoms[sample, slot], values[sample, slot]
            energy[target] += value * value
            for i in range(len(left)):
                pull[target, i] += value * left[i]
        whole = _square(signals[sample])
        if whole > 0:
            explained += 1 - float(_square(left)) / float(whole)
            count += 1
    return explained, count


@njit(cache=True, fastmath=True)
def _square(row: NDArray[np.float32]) -> np.float32:
    total = np.float32(0)
    for i in range(len(row)):
        total += row[i] * row[i]
    return total
