"""How often the intervals of paired differences hold the truth, on simulated drives whose frames correlate."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
import pytest

from vprbench.paired import compare
from vprbench.sweep import Cell
from vprbench.trace import Trace

Traces = dict[Cell, Trace]


def trace_of(correct: np.ndarray) -> Trace:
    """A straight drive, a frame a metre, everywhere equally sure."""
    size = len(correct)
    return Trace(
        frame=np.arange(size),
        truth=np.arange(size),
        hypothesis=np.arange(size),
        confidence=np.ones(size),
        error_m=np.zeros(size),
        tolerance_m=np.zeros(size),
        correct=correct,
        correct_metric=correct,
        rank=np.where(correct, 0, -1),
        rank_metric=np.where(correct, 0, -1),
        east=1.0 * np.arange(size),
        north=np.zeros(size),
    )


def correlated(rng: np.random.Generator, rho: float, shape: tuple[int, int]) -> np.ndarray:
    """Rows of an AR(1) process, one a frame, of standard normal values."""
    state, rows = rng.standard_normal(shape[1]), []
    for _ in range(shape[0]):
        rows.append(state)
        state = rho * state + np.sqrt(1 - rho**2) * rng.standard_normal(shape[1])
    return np.stack(rows)


@dataclass(frozen=True)
class World:
    """Two agents right on 80 and 70 % of their queries: common difficulty, own luck, and seeds that differ."""

    queries: int
    routes: int = 1
    seeds: int = 1
    rho: float = 0.5
    spread: float = 0.0
    right: tuple[float, float] = (0.8, 0.7)

    def traces(self, rng: np.random.Generator) -> Traces:
        skills = self.spread * rng.standard_normal((2, self.seeds))
        # Raised so that on average over seeds the share right is what was asked.
        bars = np.array([NormalDist().inv_cdf(p) for p in self.right])[:, None] * np.sqrt(1 + self.spread**2) + skills
        found: Traces = {}
        for route in range(self.routes):
            common = correlated(rng, self.rho, (self.queries, 1))
            own = correlated(rng, self.rho, (self.queries, 2 * self.seeds))
            latent = (np.sqrt(0.6) * common + np.sqrt(0.4) * own).T.reshape(2, self.seeds, -1)
            for agent, seed in np.ndindex(2, self.seeds):
                cell = Cell(f"R{route}", "ab"[agent], 2.0, seed)
                found[cell] = trace_of(latent[agent, seed] < bars[agent, seed])
        return found

    def coverage(self, drives: int) -> float:
        """Share of simulated drives whose interval holds the true difference."""
        rng, truth = np.random.default_rng(5), self.right[0] - self.right[1]
        tables = (compare(self.traces(rng), "accuracy", reference="b", resamples=300) for _ in range(drives))
        bounds = np.array([table[["low", "high"]].iloc[0] for table in tables])
        return float(((bounds[:, 0] <= truth) & (truth <= bounds[:, 1])).mean())


@pytest.mark.parametrize(
    ("world", "least"),
    [
        (World(80), 0.90),
        (World(250), 0.90),
        (World(80, routes=3), 0.90),
        (World(250, routes=3, seeds=5, spread=0.4), 0.90),
        (World(80, rho=0.8), 0.84),
        (World(120, right=(0.7, 0.7)), 0.90),
    ],
)
def test_intervals_hold_the_true_difference(world: World, least: float) -> None:
    """Of 200 drives; docs/statistics.md has the figures for 2000 (and equal agents are seldom found to differ)."""
    assert least <= world.coverage(200) <= 0.995
