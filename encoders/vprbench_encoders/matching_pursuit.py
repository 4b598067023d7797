"""Matching pursuit: a signal as the sum of a few atoms, each the one that best fits what is still unexplained.

S. Mallat, Z. Zhang, "Matching pursuits with time-frequency dictionaries", IEEE Trans. Signal Processing 1993. For
unit-length atoms phi_i and a signal I, starting from the correlations c_i = <phi_i, I>, repeat

    i* = argmax_i score_i(c_i)        a_i* += c_i*        c_i -= c_i* <phi_i*, phi_i>

so that after one matrix product a pick costs one argmax and one row of the Gram matrix. The score is how L. Perrinet,
"Role of homeostasis in learning sparse representations", Neural Computation 2010, keeps all atoms in use.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int32
from numba import njit
from numpy.typing import NDArray

__all__ = ["SCALE", "Selection", "SparseCode", "by_correlation", "pursue", "reconstruction_rate", "residuals"]

# C in r(c) = 1 - exp(-c/C), in units of a signal whose values have unit variance; as Perrinet's public code has it.
SCALE = 5.0


class SparseCode(NamedTuple):
    """The atoms that each sample is made of, at most once each; a slot with value 0 is not used.

    Shapes:
        atoms: int32 (samples, picks).
        values: float32 (samples, picks), their coefficients.
    """

    atoms: Int32[np.ndarray, "samples picks"]
    values: Float32[np.ndarray, "samples picks"]


class Selection(NamedTuple):
    """How strongly each atom competes: score_i = gain_i c, or where there are tables score_i = z_i(r(c)).

    Shapes:
        gain: float32 (atoms,).
        tables: float32 (atoms, bins + 1), z_i at r = 0, 1/bins, ..., 1, linear between; or (0, 0).
    """

    gain: Float32[np.ndarray, " atoms"]
    tables: Float32[np.ndarray, "atoms knots"]


def by_correlation(atoms: int) -> Selection:
    """Plain matching pursuit: every atom competes with its own correlation."""
    return Selection(np.ones(atoms, np.float32), np.empty((0, 0), np.float32))


def pursue(
    signals: Float32[np.ndarray, "samples size"],
    dictionary: Float32[np.ndarray, "atoms size"],
    gram: Float32[np.ndarray, "atoms atoms"],
    picks: int,
    selection: Selection,
    rectified: bool = True,
) -> SparseCode:
    """The sparse code of each signal.

    Args:
        signals: one a row.
        dictionary: one atom of unit length a row.
        gram: dictionary @ dictionary.T, which the caller can share between calls.
        picks: how many times an atom is picked; fewer where none competes any more.
        selection: how atoms compete.
        rectified: only positive correlations compete; else |c| does.
    """
    code = SparseCode(np.zeros((len(signals), picks), np.int32), np.zeros((len(signals), picks), np.float32))
    _pursue(signals @ dictionary.T, gram, selection, np.float32(0 if rectified else -1), *code)
    return code


def residuals(
    signals: Float32[np.ndarray, "samples size"], dictionary: Float32[np.ndarray, "atoms size"], code: SparseCode
) -> Float32[np.ndarray, "samples size"]:
    """What the code leaves unexplained of each signal: I - Phi a."""
    left = signals.copy()
    _subtract(left, dictionary, *code)
    return left


def reconstruction_rate(
    signals: Float32[np.ndarray, "samples size"], dictionary: Float32[np.ndarray, "atoms size"], code: SparseCode
) -> float:
    """Mean of 1 - |I - Phi a|^2 / |I|^2 over the signals that are not zero; NaN where there is none."""
    energy = np.square(signals).sum(axis=1)
    left = np.square(residuals(signals, dictionary, code)).sum(axis=1)
    some = energy > 0
    return float(1 - (left[some] / energy[some]).mean()) if some.any() else float("nan")


@njit(cache=True, fastmath=True)
def _pursue(
    correlations: NDArray[np.float32],
    gram: NDArray[np.float32],
    selection: Selection,
    mirror: np.float32,
    atoms: NDArray[np.int32],
    values: NDArray[np.float32],
) -> None:
    scores = np.empty(correlations.shape[1], np.float32)
    knots = np.empty(correlations.shape[1], np.int32)
    for sample in range(len(correlations)):
        c = correlations[sample]
        for pick in range(atoms.shape[1]):
            for i in range(len(c)):
                scores[i] = max(c[i], mirror * c[i])
            _compete(scores, selection, knots)
            best = _largest(scores)
            if scores[best] <= 0:
                break
            value = c[best]
            _record(atoms[sample], values[sample], pick, best, value)
            row = gram[best]
            for i in range(len(c)):
                c[i] -= value * row[i]


# Each loop below is one plain pass over contiguous memory, so that it runs in vector lanes.
@njit(cache=True, fastmath=True)
def _compete(scores: NDArray[np.float32], selection: Selection, knots: NDArray[np.int32]) -> None:
    """Turn correlations into scores, in place."""
    gain, tables = selection
    if len(tables) == 0:
        for i in range(len(scores)):
            scores[i] *= gain[i]
        return
    width = np.int32(tables.shape[1])
    table = tables.ravel()
    for i in range(len(scores)):
        position = _rescaled(scores[i]) * np.float32(width - 1)
        knot = min(np.int32(position), width - np.int32(2))
        scores[i] = position - np.float32(knot)
        knots[i] = np.int32(i) * width + knot
    for i in range(len(scores)):
        below, above = table[np.uint32(knots[i])], table[np.uint32(knots[i] + 1)]
        scores[i] = below + (above - below) * scores[i]


@njit(cache=True, fastmath=True)
def _rescaled(c: np.float32) -> np.float32:
    """r(c) = 1 - exp(-c/C) to 1e-6; exp(-x) is taken as exp(-x/32)^32, as a call of exp would not vectorise."""
    x = min(c * np.float32(1 / SCALE), np.float32(16)) * np.float32(1 / 32)
    power = np.float32(1) - x * (np.float32(1) - x * (np.float32(1 / 2) - x * np.float32(1 / 6)))
    for _ in range(5):
        power *= power
    return np.float32(1) - power


@njit(cache=True, fastmath=True)
def _largest(scores: NDArray[np.float32]) -> int:
    """Index of the largest score, the first of equals; any index where none is above zero."""
    # Positive floats order as their bits do, and a maximum of integers vectorises where one of floats does not.
    bits = scores.view(np.int32)
    best = np.int32(0)
    for i in range(len(bits)):
        best = max(best, bits[i])
    rank = np.int32(1)
    for i in range(len(bits)):
        rank = max(rank, np.int32(len(bits) - i) if bits[i] == best else np.int32(0))
    return int(len(bits) - rank)


@njit(cache=True)
def _record(atoms: NDArray[np.int32], values: NDArray[np.float32], pick: int, atom: int, value: np.float32) -> None:
    """Add a pick to one sample's code: to the atom's earlier slot, if it was picked before."""
    slot = pick
    for earlier in range(pick):
        if atoms[earlier] == atom and values[earlier] != 0:
            slot = earlier
    atoms[slot] = atom
    values[slot] += value


@njit(cache=True, fastmath=True)
def _subtract(
    left: NDArray[np.float32],
    dictionary: NDArray[np.float32],
    atoms: NDArray[np.int32],
    values: NDArray[np.float32],
) -> None:
    for sample in range(len(left)):
        for slot in range(atoms.shape[1]):
            value = values[sample, slot]
            atom = dictionary[atoms[sample, slot]]
            for i in range(left.shape[1]):
                left[sample, i] -= value * atom[i]
