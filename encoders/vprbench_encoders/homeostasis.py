"""Homeostasis: what keeps every atom of a dictionary in use while it is learned.

Without it an atom that is picked early is learned early, fits better and is picked again. L. Perrinet's two cures:

    "heh", histogram equalisation (Neural Computation 2010)   score_i = z_i(r(c)),  z_i <- (1-eta) z_i + eta P(a_i <= .)
    "hap", activation gain (Vision 2019)                      score_i = c log(p_i) / log(p_0),  p_i = P(a_i > 0)
"""

from __future__ import annotations

from typing import Literal, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Float64

from vprbench_encoders.matching_pursuit import SCALE, Selection, SparseCode, by_correlation

__all__ = ["Homeostasis", "Kind", "homeostasis", "usage", "usage_entropy"]

Kind = Literal["none", "heh", "hap"]


@runtime_checkable
class Homeostasis(Protocol):
    """How atoms compete, as it follows from how they were used so far."""

    selection: Selection

    def update(self, code: SparseCode) -> None:
        """Take one batch of codes into account."""
        ...


def homeostasis(kind: Kind, atoms: int, picks: int, rate: float, bins: int) -> Homeostasis:
    """A new homeostasis.

    Args:
        kind: "none", "heh" or "hap".
        atoms: of the dictionary.
        picks: of the pursuit, N0.
        rate: eta, the share that one batch has in the running average.
        bins: of the tables of "heh".
    """
    if kind == "heh":
        return _Equalisation(atoms, rate, bins)
    if kind == "hap":
        return _Gain(atoms, picks, rate)
    return _Nothing(atoms)


def usage(code: SparseCode, atoms: int) -> Float64[np.ndarray, " atoms"]:
    """The share of samples that each atom takes part in."""
    return np.bincount(code.atoms[code.values != 0], minlength=atoms) / max(len(code.atoms), 1)


def usage_entropy(used: Float[np.ndarray, " atoms"]) -> float:
    """How evenly atoms of this usage are used: entropy of their shares, 1 for equal shares, 0 for a single atom."""
    share = used[used > 0] / used.sum()
    return float(-(share * np.log(share)).sum() / np.log(len(used)))


class _Nothing:
    """Every atom competes with its own correlation."""

    def __init__(self, atoms: int) -> None:
        self.selection = by_correlation(atoms)

    def update(self, code: SparseCode) -> None:
        """Do nothing."""


class _Gain:
    """An atom used more often than p_0 = N0 / atoms competes with less than its correlation, and conversely."""

    def __init__(self, atoms: int, picks: int, rate: float) -> None:
        self.selection = by_correlation(atoms)
        self._rate = rate
        self._target = picks / atoms
        self._probability = np.full(atoms, self._target)

    def update(self, code: SparseCode) -> None:
        """Follow the probability of each atom's activation."""
        self._probability += self._rate * (usage(code, len(self._probability)) - self._probability)
        gain = np.log(self._probability) / np.log(self._target)
        self.selection = self.selection._replace(gain=gain.astype(np.float32))


class _Equalisation:
    """A coefficient competes with the share of the atom's own coefficients, zeros counted, that lie below it."""

    def __init__(self, atoms: int, rate: float, bins: int) -> None:
        tables = np.tile(np.linspace(0, 1, bins + 1, dtype=np.float32), (atoms, 1))
        self.selection = by_correlation(atoms)._replace(tables=tables)
        self._rate = np.float32(rate)

    def update(self, code: SparseCode) -> None:
        """Follow each atom's cumulative distribution."""
        # z_i(0) stays 0: an atom without any correlation never wins, however rarely it is used.
        tables = self.selection.tables[:, 1:]
        tables += self._rate * (_cumulative(code, *tables.shape) - tables)


def _cumulative(code: SparseCode, atoms: int, bins: int) -> Float64[np.ndarray, "atoms bins"]:
    """P(a_i <= upper edge of each bin of r), over the samples of one batch."""
    used = code.values != 0
    rescaled = 1 - np.exp(-np.abs(code.values[used]) / SCALE)
    place = code.atoms[used] * bins + np.minimum((rescaled * bins).astype(np.int64), bins - 1)
    counts = np.bincount(place, minlength=atoms * bins).reshape(atoms, bins)
    counts[:, 0] += len(code.values) - counts.sum(axis=1)
    return counts.cumsum(axis=1) / len(code.values)
