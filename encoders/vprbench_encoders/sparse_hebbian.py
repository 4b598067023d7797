"""Sparse Hebbian learning: a dictionary whose atoms, few at a time, add up to the signals it is shown.

Homeostatic sparse Hebbian learning (L. Perrinet, Neural Computation 2010) codes a batch by matching pursuit and then
moves every atom towards what its coefficient left unexplained:

    plain    phi_i <- phi_i + eta <a_i (I - Phi a)>                         then unit length
    scaled   phi_i <- phi_i + eta <a_i (I - Phi a)> / <a_i^2>

The plain rule moves an atom by its share of the batch, so the more atoms, the slower; the scaled one divides by that
share (it is Newton's step along phi_i: at eta = 1 the atom that fits the batch best, given the codes). With eta falling
linearly to 0 it needs some twentieth of the plain rule's steps; this is our choice, not the paper's.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import cycle, islice
from typing import Literal

import numpy as np
from jaxtyping import Float32
from numba import njit
from numpy.typing import NDArray

from vprbench.errors import ConfigError
from vprbench_encoders.homeostasis import Kind, homeostasis
from vprbench_encoders.matching_pursuit import Selection, SparseCode, pursue

__all__ = ["Rule", "SparseHebbian", "hebbian_sums", "unit_length"]

Rule = Literal["plain", "scaled"]


@dataclass(frozen=True, kw_only=True)
class SparseHebbian:
    """How a dictionary is learned.

    Attributes:
        picks: N0, atoms in the code of one signal.
        homeostasis: "heh" (the paper's), "hap" or "none".
        homeostasis_rate: eta_h.
        bins: of the tables of "heh".
        rule: "scaled" or "plain".
        rate: eta; signals are taken to have values of unit variance.
        batch: signals a step.
        steps: batches seen, unless ...
        passes: ... each signal has then been seen so many times.
        rectified: whether coefficients are positive.
    """

    picks: int
    homeostasis: Kind = "heh"
    homeostasis_rate: float = 0.01
    bins: int = 128
    rule: Rule = "scaled"
    rate: float = 0.4
    batch: int = 1024
    steps: int = 200
    passes: int = 20
    rectified: bool = True

    def __post_init__(self) -> None:
        """Refuse values with which nothing could be learned."""
        for name in ("picks", "bins", "batch", "steps", "passes"):
            if not getattr(self, name) >= 1:
                raise ConfigError(f"sparse Hebbian learning: {name} must be at least 1, not {getattr(self, name)}")
        for name in ("rate", "homeostasis_rate"):
            if not 0 < getattr(self, name) <= 1:
                raise ConfigError(
                    f"sparse Hebbian learning: {name} must be above 0, at most 1, not {getattr(self, name)}"
                )

    def learn(
        self, signals: Float32[np.ndarray, "samples size"], atoms: int, random: np.random.Generator
    ) -> Float32[np.ndarray, "atoms size"]:
        """A dictionary for these signals, one atom of unit length a row, learned from noise."""
        dictionary = unit_length(random.standard_normal((atoms, signals.shape[1]), np.float32))
        balance = homeostasis(self.homeostasis, atoms, self.picks, self.homeostasis_rate, self.bins)
        batches = self._batches(signals, random)
        for step, batch in enumerate(batches):
            code = self.code(batch, dictionary, balance.selection)
            pull, energy = hebbian_sums(batch, dictionary, code)
            dictionary = unit_length(dictionary + self._rates(step / len(batches), len(batch), energy)[:, None] * pull)
            balance.update(code)
        return dictionary

    def equalise(
        self,
        signals: Float32[np.ndarray, "samples size"],
        dictionary: Float32[np.ndarray, "atoms size"],
        random: np.random.Generator,
    ) -> Selection:
        """How the atoms of a fixed dictionary compete, once homeostasis has followed them."""
        balance = homeostasis(self.homeostasis, len(dictionary), self.picks, self.homeostasis_rate, self.bins)
        for batch in self._batches(signals, random):
            balance.update(self.code(batch, dictionary, balance.selection))
        return balance.selection

    def code(
        self,
        signals: Float32[np.ndarray, "samples size"],
        dictionary: Float32[np.ndarray, "atoms size"],
        selection: Selection,
    ) -> SparseCode:
        """The sparse codes of signals in a dictionary."""
        return pursue(signals, dictionary, dictionary @ dictionary.T, self.picks, selection, self.rectified)

    def _batches(
        self, signals: Float32[np.ndarray, "samples size"], random: np.random.Generator
    ) -> list[Float32[np.ndarray, "batch size"]]:
        """Batch after batch of the shuffled signals, which start anew when they end."""
        # One shuffle: slices of it cost nothing, where rows gathered for each batch cost as much as coding them.
        shuffled = signals[random.permutation(len(signals))]
        starts = range(0, len(signals), self.batch)
        steps = min(self.steps, self.passes * len(starts))
        return [shuffled[start : start + self.batch] for start in islice(cycle(starts), steps)]

    def _rates(
        self, progress: float, samples: int, energy: Float32[np.ndarray, " atoms"]
    ) -> Float32[np.ndarray, " atoms"]:
        """What the sums of a_i (I - Phi a) over a batch of so many samples are multiplied by."""
        if self.rule == "plain":
            return np.full(len(energy), self.rate / samples, np.float32)
        return np.float32(self.rate * (1 - progress)) / np.maximum(energy, np.finfo(np.float32).tiny)


def unit_length(rows: Float32[np.ndarray, "n size"]) -> Float32[np.ndarray, "n size"]:
    """The rows scaled to unit length; a row of zeros stays as it is."""
    length = np.sqrt(np.einsum("ij,ij->i", rows, rows))[:, None]
    return rows / np.where(length > 0, length, np.float32(1))


def hebbian_sums(
    signals: Float32[np.ndarray, "samples size"], dictionary: Float32[np.ndarray, "atoms size"], code: SparseCode
) -> tuple[Float32[np.ndarray, "atoms size"], Float32[np.ndarray, " atoms"]]:
    """Sums over the samples of a_i (I - Phi a) and of a_i^2, for each atom."""
    pull, energy = np.zeros_like(dictionary), np.zeros(len(dictionary), np.float32)
    _accumulate(signals, dictionary, *code, pull, energy)
    return pull, energy


@njit(cache=True, fastmath=True)
def _accumulate(
    signals: NDArray[np.float32],
    dictionary: NDArray[np.float32],
    atoms: NDArray[np.int32],
    values: NDArray[np.float32],
    pull: NDArray[np.float32],
    energy: NDArray[np.float32],
) -> None:
    left = np.empty(signals.shape[1], np.float32)
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
