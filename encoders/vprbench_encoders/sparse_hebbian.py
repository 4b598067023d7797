"""Sparse Hebbian learning: a dictionary whose atoms, few at a time, add up to the signals it is shown.

Homeostatic sparse Hebbian learning (L. Perrinet, Neural Computation 2010) codes a batch by matching pursuit and then
moves every atom towards what its coefficient left unexplained:

    plain    phi_i <- phi_i + eta <a_i (I - Phi a)>                         then unit length
    scaled   phi_i <- phi_i + eta <a_i (I - Phi a)> / <a_i^2>

The plain rule moves an atom by its share of the batch, so the more atoms, the slower; the scaled one divides by that
share (it is Newton's step along phi_i: at eta = 1 the atom that fits the batch best, given the codes). With eta falling
linearly to 0 it needs some twentieth of the plain rule's steps; this is our choice, not the paper's.

Either can end once it has converged. On KITTI, a tolerance of 5e-4 lets the plain rule end S1 after 1508 of 4000 steps
for 144 atoms and after 2088 for 225, at 0.002 and 0.001 of its held-out rate. The scaled rule does not converge before
its 200 steps are over: its atoms get better for as long as eta falls.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float32

from vprbench.errors import ConfigError
from vprbench_encoders.convergence import Fall, Passes
from vprbench_encoders.hebbian import hebbian_sums
from vprbench_encoders.homeostasis import Kind, homeostasis
from vprbench_encoders.matching_pursuit import Selection, SparseCode, pursue, reconstruction_rate
from vprbench_encoders.stepwise import Progress, Work, finished

__all__ = ["Rule", "SparseHebbian", "unit_length"]

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
        passes: ... each signal has then been seen so many times, or ...
        tolerance: ... a pass is coded at a rate that is not better by so much than that of the pass before; the plain
            rule then ends, eta of the scaled one falls to 0 within one more pass. 0: never.
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
    tolerance: float = 0.0
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
        if not 0 <= self.tolerance < 1:
            raise ConfigError(
                f"sparse Hebbian learning: tolerance must be at least 0 and below 1, not {self.tolerance}"
            )

    def learn(
        self, signals: Float32[np.ndarray, "samples size"], atoms: int, random: np.random.Generator
    ) -> Float32[np.ndarray, "atoms size"]:
        """A dictionary for these signals, one atom of unit length a row, learned from noise."""
        return finished(self.learning(signals, atoms, random))

    def learning(
        self, signals: Float32[np.ndarray, "samples size"], atoms: int, random: np.random.Generator
    ) -> Work[Float32[np.ndarray, "atoms size"]]:
        """What `learn` does, batch by batch."""
        dictionary = unit_length(random.standard_normal((atoms, signals.shape[1]), np.float32))
        balance = homeostasis(self.homeostasis, atoms, self.picks, self.homeostasis_rate, self.bins)
        batches = _Batches(signals, self.batch, random)
        passes, fall = Passes(len(batches), self.tolerance), Fall(0, self._steps(batches))
        step = 0
        while step < fall.end:
            batch = batches[step]
            code = self.code(batch, dictionary, balance.selection)
            pull, energy, rate = hebbian_sums(batch, dictionary, code)
            dictionary = unit_length(dictionary + self._rates(fall.share(step), len(batch), energy)[:, None] * pull)
            balance.update(code)
            step += 1
            if passes.converged(rate):
                fall = fall.shortened(step, 0 if self.rule == "plain" else len(batches))
            yield _coded(step, fall.end, rate)
        return dictionary

    def equalising(
        self,
        signals: Float32[np.ndarray, "samples size"],
        dictionary: Float32[np.ndarray, "atoms size"],
        random: np.random.Generator,
    ) -> Work[Selection]:
        """How the atoms of a fixed dictionary compete, once homeostasis has followed them, batch by batch."""
        balance = homeostasis(self.homeostasis, len(dictionary), self.picks, self.homeostasis_rate, self.bins)
        batches = _Batches(signals, self.batch, random)
        steps = self._steps(batches)
        for step in range(steps):
            batch = batches[step]
            code = self.code(batch, dictionary, balance.selection)
            balance.update(code)
            yield _coded(step + 1, steps, reconstruction_rate(batch, dictionary, code))
        return balance.selection

    def code(
        self,
        signals: Float32[np.ndarray, "samples size"],
        dictionary: Float32[np.ndarray, "atoms size"],
        selection: Selection,
    ) -> SparseCode:
        """The sparse codes of signals in a dictionary."""
        return pursue(signals, dictionary, dictionary @ dictionary.T, self.picks, selection, self.rectified)

    def _steps(self, batches: _Batches) -> int:
        return min(self.steps, self.passes * len(batches))

    def _rates(
        self, share: float, samples: int, energy: Float32[np.ndarray, " atoms"]
    ) -> Float32[np.ndarray, " atoms"]:
        """What the sums of a_i (I - Phi a) over a batch of so many samples are multiplied by."""
        if self.rule == "plain":
            return np.full(len(energy), self.rate / samples, np.float32)
        return np.float32(self.rate * share) / np.maximum(energy, np.finfo(np.float32).tiny)


def _coded(done: int, total: int, rate: float) -> Progress:
    """So many batches are done, the last of which was coded at this reconstruction rate."""
    return Progress(done, total, f"reconstruction rate {rate:.2f}")


class _Batches:
    """Batch after batch of the shuffled signals, which start anew when they end; `len` is the batches of one pass."""

    def __init__(self, signals: Float32[np.ndarray, "samples size"], size: int, random: np.random.Generator) -> None:
        # One shuffle: slices of it cost nothing, where rows gathered for each batch cost as much as coding them.
        self._shuffled = signals[random.permutation(len(signals))]
        self._size = size

    def __len__(self) -> int:
        return -(-len(self._shuffled) // self._size)

    def __getitem__(self, step: int) -> Float32[np.ndarray, "batch size"]:
        start = step % len(self) * self._size
        return self._shuffled[start : start + self._size]


def unit_length(rows: Float32[np.ndarray, "n size"]) -> Float32[np.ndarray, "n size"]:
    """The rows scaled to unit length; a row of zeros stays as it is."""
    length = np.sqrt(np.einsum("ij,ij->i", rows, rows))[:, None]
    return rows / np.where(length > 0, length, np.float32(1))
