"""One topological sparse layer with its pooling: S1 with C1, or S2 with C2.

Its dictionary is learned first; then a self-organising map is ordered with the atoms as samples, and the map's units,
scaled to unit length, are the dictionary that codes from then on. So units that touch code alike features, and a
maximum over them changes little when the signal shifts a little.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from time import perf_counter
from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int64

from vprbench_encoders.homeostasis import usage, usage_entropy
from vprbench_encoders.matching_pursuit import Selection, SparseCode, by_correlation, pursue, reconstruction_rate
from vprbench_encoders.pooling import max_pool, pooling_cells
from vprbench_encoders.som import KohonenMap
from vprbench_encoders.sparse_hebbian import SparseHebbian, unit_length
from vprbench_encoders.stepwise import Progress, Stage, Work, finished, named

__all__ = ["LayerRecipe", "LayerReport", "Rates", "TopologicalLayer", "prepared"]

# Signals coded at a time: their correlations with 900 units take 3.5 MiB.
_CHUNK = 1024

# Signals of which a report takes its rates.
_REPORTED = 2048


class Rates(NamedTuple):
    """Mean reconstruction rate 1 - |I - Phi a|^2 / |I|^2 of patches learned from, and of patches held out."""

    training: float
    held_out: float


@dataclass(frozen=True, eq=False)
class LayerReport:
    """What a layer has learned.

    Attributes:
        atoms: rates of the dictionary as it was learned.
        units: rates of the map's units, which code from then on.
        usage: (units,), the share of training patches that each unit takes part in.
        seconds: that learning and ordering took.
    """

    atoms: Rates
    units: Rates
    usage: Float32[np.ndarray, " units"]
    seconds: float

    @property
    def entropy(self) -> float:
        """How evenly the units are used, 0..1."""
        return usage_entropy(self.usage)

    def measures(self) -> dict[str, float]:
        """The report as numbers: the rates of the atoms, those of the map's units, usage entropy and seconds.

        A rate is left out where nothing was held out to take it of.
        """
        rates = {
            "rate": self.atoms.training,
            "rate_held_out": self.atoms.held_out,
            "map_rate": self.units.training,
            "map_rate_held_out": self.units.held_out,
        }
        known = {name: rate for name, rate in rates.items() if isfinite(rate)}
        return known | {"usage_entropy": self.entropy, "seconds": self.seconds}


@dataclass(frozen=True)
class TopologicalLayer:
    """A learned layer.

    Attributes:
        units: (units, size), the map's units of unit length, row after row of the map.
        mean: (size,), subtracted from what is coded.
        selection: how the units compete.
        cells: (units,), the pooled cell of each unit, -1 for none.
        picks: N0.
        rectified: whether coefficients are positive.
    """

    units: Float32[np.ndarray, "units size"]
    mean: Float32[np.ndarray, " size"]
    selection: Selection
    cells: Int64[np.ndarray, " units"]
    picks: int
    rectified: bool

    @property
    def size(self) -> int:
        """How many cells it answers with."""
        return int(self.cells.max()) + 1

    @cached_property
    def _columns(self) -> Float32[np.ndarray, "units size"]:
        """The units in column order, in which a few signals are correlated with them in two thirds of the time."""
        return np.asfortranarray(self.units)

    @cached_property
    def _gram(self) -> Float32[np.ndarray, "units units"]:
        return self.units @ self.units.T

    def code(self, signals: Float32[np.ndarray, "samples size"]) -> SparseCode:
        """The sparse codes of signals that are `prepared`."""
        return pursue(signals, self._columns, self._gram, self.picks, self.selection, self.rectified)

    def pooled(self, inputs: Float32[np.ndarray, "samples size"]) -> Float32[np.ndarray, "samples cells"]:
        """The layer's answer to its inputs: their codes, pooled."""
        return finished(self.pooling(inputs))

    def pooling(self, inputs: Float32[np.ndarray, "samples size"]) -> Work[Float32[np.ndarray, "samples cells"]]:
        """What `pooled` does, some inputs at a time."""
        answers = []
        for first in range(0, max(len(inputs), 1), _CHUNK):
            chunk = inputs[first : first + _CHUNK]
            answers.append(max_pool(self.code(prepared(chunk, self.mean)), self.cells))
            yield Progress(first + len(chunk), len(inputs))
        return np.concatenate(answers)


@dataclass(frozen=True, kw_only=True)
class LayerRecipe:
    """How a layer is learned.

    Attributes:
        learning: of the dictionary.
        atoms: of the dictionary.
        side: of the map.
        ordering: of the map; None: the atoms themselves are the units, in the order of their learning.
        pool: rows and columns of a pooling window; 1: no pooling.
        centred: whether the mean of the training inputs is subtracted.
        equalised: whether homeostasis goes on when the layer is used, followed anew on its units.
    """

    learning: SparseHebbian
    atoms: int
    side: int
    ordering: KohonenMap | None
    pool: int
    centred: bool
    equalised: bool

    def follow(
        self,
        name: str,
        inputs: Float32[np.ndarray, "samples size"],
        held_out: Float32[np.ndarray, "others size"],
        random: np.random.Generator,
    ) -> Stage[tuple[TopologicalLayer, LayerReport]]:
        """The layer that these inputs teach, and what it has learned, also measured on inputs held out.

        The stages of layer "S1" are "S1 dictionary", "S1 map" and, where it is equalised, "S1 homeostasis".
        """
        start = perf_counter()
        mean = inputs.mean(axis=0) if self.centred else np.zeros(inputs.shape[1], np.float32)
        signals = prepared(inputs, mean)
        units = atoms = yield from named(f"{name} dictionary", self.learning.learning(signals, self.atoms, random))
        if self.ordering:
            ordered = yield from named(f"{name} map", self.ordering.ordering(atoms, self.side, random))
            units = unit_length(ordered)
        selection = by_correlation(len(units))
        if self.equalised:
            selection = yield from named(f"{name} homeostasis", self.learning.equalising(signals, units, random))
        layer = self.layer(units, mean, selection)
        seconds = perf_counter() - start
        return layer, self._report(layer, atoms, signals, prepared(held_out, mean), seconds)

    def layer(
        self, units: Float32[np.ndarray, "units size"], mean: Float32[np.ndarray, " size"], selection: Selection
    ) -> TopologicalLayer:
        """The layer, given what is learned of it."""
        cells = pooling_cells(self.side, self.pool)
        return TopologicalLayer(units, mean, selection, cells, self.learning.picks, self.learning.rectified)

    def _report(
        self,
        layer: TopologicalLayer,
        atoms: Float32[np.ndarray, "atoms size"],
        signals: Float32[np.ndarray, "samples size"],
        held_out: Float32[np.ndarray, "others size"],
        seconds: float,
    ) -> LayerReport:
        some = [kept[:: max(len(kept) // _REPORTED, 1)] for kept in (signals, held_out)]
        of_atoms = Rates(*(self._rate(kept, atoms, by_correlation(len(atoms))) for kept in some))
        of_units = Rates(*(self._rate(kept, layer.units, layer.selection) for kept in some))
        used = usage(layer.code(some[0]), len(layer.units)).astype(np.float32)
        return LayerReport(of_atoms, of_units, used, seconds)

    def _rate(
        self,
        signals: Float32[np.ndarray, "samples size"],
        dictionary: Float32[np.ndarray, "atoms size"],
        selection: Selection,
    ) -> float:
        return reconstruction_rate(signals, dictionary, self.learning.code(signals, dictionary, selection))


def prepared(
    inputs: Float32[np.ndarray, "samples size"], mean: Float32[np.ndarray, " size"]
) -> Float32[np.ndarray, "samples size"]:
    """The inputs as signals to code: less the mean, scaled to a mean square of 1; without contrast, zero."""
    signals = inputs - mean
    length = np.sqrt(np.einsum("ij,ij->i", signals, signals))
    signals *= (np.sqrt(inputs.shape[1]) / np.where(length > 0, length, np.inf)).astype(np.float32)[:, None]
    return signals
