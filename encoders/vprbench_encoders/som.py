"""The self-organising map: a square grid of units on which neighbours come to resemble each other.

T. Kohonen, "Essentials of the self-organizing map", Neural Networks 2013. The batch form: every sample goes to the unit
nearest to it, then each unit becomes the mean of all samples weighted by exp(-d^2 / 2 sigma^2), d being the distance
on the grid between the unit and the sample's; sigma falls from epoch to epoch. It needs no learning rate, and gives in
60 epochs what 500 updates a unit of the online rule w <- w + alpha h (x - w) give.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int64

from vprbench.errors import ConfigError
from vprbench_encoders.stepwise import Progress, Work, finished

__all__ = ["KohonenMap", "nearest_units", "topographic_error"]

# A unit with less than this weight is so far from all samples that it stays as it is.
_FAINT = np.float32(1e-20)


@dataclass(frozen=True, kw_only=True)
class KohonenMap:
    """How a map is ordered.

    Attributes:
        epochs: over all samples.
        neighbourhood: sigma of the first epoch, in units of the grid.
        final_neighbourhood: sigma of the last one.
    """

    epochs: int = 60
    neighbourhood: float = 4.0
    final_neighbourhood: float = 0.5

    def __post_init__(self) -> None:
        """Refuse values with which no map could be ordered."""
        if not self.epochs >= 1:
            raise ConfigError(f"self-organising map: epochs must be at least 1, not {self.epochs}")
        if not 0 < self.final_neighbourhood <= self.neighbourhood:
            raise ConfigError(
                "self-organising map: the neighbourhood must fall and stay above 0, "
                f"not go from {self.neighbourhood} to {self.final_neighbourhood}"
            )

    def order(
        self, samples: Float32[np.ndarray, "samples size"], side: int, random: np.random.Generator
    ) -> Float32[np.ndarray, "units size"]:
        """The side x side units, row after row, that map these samples."""
        return finished(self.ordering(samples, side, random))

    def ordering(
        self, samples: Float32[np.ndarray, "samples size"], side: int, random: np.random.Generator
    ) -> Work[Float32[np.ndarray, "units size"]]:
        """What `order` does, epoch by epoch."""
        units = samples[random.integers(len(samples), size=side * side)]
        sigmas = np.geomspace(self.neighbourhood, self.final_neighbourhood, self.epochs)
        for done, sigma in enumerate(sigmas.tolist(), 1):
            units = _epoch(samples, units, side, sigma)
            yield Progress(done, self.epochs)
        return units


def nearest_units(
    samples: Float32[np.ndarray, "samples size"], units: Float32[np.ndarray, "units size"], count: int = 1
) -> Int64[np.ndarray, "samples count"]:
    """The units nearest to each sample, the nearest first."""
    # |x - w|^2 less the |x|^2 that all units share.
    distance = np.square(units).sum(axis=1) - 2 * samples @ units.T
    return np.argsort(distance, axis=1, kind="stable")[:, :count] if count > 1 else distance.argmin(axis=1)[:, None]


def topographic_error(
    samples: Float32[np.ndarray, "samples size"], units: Float32[np.ndarray, "units size"], side: int
) -> float:
    """The share of samples whose two nearest units do not touch on the grid, not even by a corner."""
    rows, columns = np.divmod(nearest_units(samples, units, 2), side)
    apart = np.maximum(np.abs(np.diff(rows)), np.abs(np.diff(columns)))
    return float((apart > 1).mean())


def _epoch(
    samples: Float32[np.ndarray, "samples size"],
    units: Float32[np.ndarray, "units size"],
    side: int,
    sigma: float,
) -> Float32[np.ndarray, "units size"]:
    winners = nearest_units(samples, units)[:, 0]
    grouped = np.argsort(winners, kind="stable")
    present, starts, counts = np.unique(winners[grouped], return_index=True, return_counts=True)
    sums = np.zeros((len(units), 1 + samples.shape[1]), np.float32)
    sums[present, 0], sums[present, 1:] = counts, np.add.reduceat(samples[grouped], starts)
    # A Gaussian on the grid is the product of one along rows and one along columns.
    offset = np.subtract.outer(np.arange(side), np.arange(side))
    near = np.exp(-np.square(offset) / (2 * sigma**2)).astype(np.float32)
    spread = np.tensordot(near, near @ sums.reshape(side, side, -1), axes=1).reshape(sums.shape)
    weight, total = spread[:, :1], spread[:, 1:]
    return np.where(weight > _FAINT, total / np.maximum(weight, _FAINT), units)
