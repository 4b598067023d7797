"""What agents score on resampled queries and seeds: all on the same ones, so that they can be compared in pairs.

Each resample draws the same stretches of road (`vprbench.bootstrap`) for all agents, distances and seeds of a route;
routes are drawn independently of each other. An agent that learned from random numbers is drawn by its seeds too: of n
seeds n - 1 with replacement, which makes the spread of their mean unbiased (Rao & Wu, "Resampling inference with
complex survey data", 1988). Agents with the same seeds share the draw, and so do all cells of an agent.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias
from zlib import crc32

import numpy as np
from jaxtyping import Float64

from vprbench.bootstrap import block_frames, resample_chunks
from vprbench.errors import DataError
from vprbench.resampled_scores import resampled_auc_and_accuracy
from vprbench.sweep import Cell
from vprbench.trace import Trace

__all__ = ["PAIRED_METRICS", "Draws", "Drive", "Place", "Scored", "score_cells"]

PAIRED_METRICS = ("auc", "auc_all", "accuracy", "auc_metric", "auc_all_metric", "accuracy_metric")

# Route and sampling distance.
Place: TypeAlias = tuple[str, float]

# One number a resample; the first is of the queries themselves.
Draws: TypeAlias = Float64[np.ndarray, " draws"]


@dataclass(frozen=True)
class Scored:
    """What one agent scored in one cell.

    Attributes:
        draws: the mean over seeds, one a resample.
        seeds: the score of each seed that was run.
    """

    draws: Draws
    seeds: Mapping[int, float]


@dataclass(frozen=True)
class Drive:
    """The queries of one route: how many, and in how many blocks they are drawn."""

    queries: int
    blocks: float


def score_cells(
    traces: Mapping[Cell, Trace], metric: str, block_m: float, resamples: int, seed: int
) -> tuple[dict[str, dict[Place, Scored]], dict[str, Drive]]:
    """Every agent's resampled scores, by its cells; and the drives behind them, by route.

    Raises:
        DataError: two traces of a route are not of the same queries.
    """
    scored: dict[str, dict[Place, Scored]] = {}
    drives: dict[str, Drive] = {}
    for route in dict.fromkeys(cell.route for cell in traces):
        there = {cell: trace for cell, trace in traces.items() if cell.route == route}
        _check_queries(route, list(there.values()))
        first = next(iter(there.values()))
        queries, block = len(first), block_frames(first, block_m)
        drives[route] = Drive(queries, queries / block)
        # A stream of its own for each route, which does not depend on what other routes there are.
        chunks = resample_chunks(queries, block, resamples, [seed, crc32(route.encode())])
        weights = np.concatenate([np.ones((1, queries), np.int64), *chunks])
        draws = {cell: _draws(trace, metric, weights) for cell, trace in there.items()}
        for agent, place, seeds in _groups(there):
            by_seed = np.stack([draws[Cell(route, agent, place[1], number)] for number in seeds])
            mean = np.einsum("sd,sd->d", _seed_shares(seeds, resamples, seed), by_seed)
            scored.setdefault(agent, {})[place] = Scored(mean, dict(zip(seeds, by_seed[:, 0].tolist(), strict=True)))
    return scored, drives


def _check_queries(route: str, traces: Sequence[Trace]) -> None:
    """Refuse traces of one route that are not of the same queries."""
    first = traces[0]
    for trace in traces:
        same = (np.array_equal(getattr(trace, name), getattr(first, name)) for name in ("frame", "east", "north"))
        if not all(same):
            raise DataError(f"compare: {route}: its traces are not of the same queries; measure the route again")


def _draws(trace: Trace, metric: str, weights: np.ndarray) -> Draws:
    """The metric of every resample of a trace."""
    name = metric.removesuffix("_metric")
    correct = trace.correct if name == metric else trace.correct_metric
    auc, accuracy = resampled_auc_and_accuracy(correct, trace.confidence, weights)
    # The area over all queries is the area times the accuracy.
    return {"auc": auc, "accuracy": accuracy}.get(name, auc * accuracy)


def _groups(cells: Iterable[Cell]) -> list[tuple[str, Place, tuple[int, ...]]]:
    """The agents and cells of one route, each with the seeds that were run."""
    seeds: dict[tuple[str, Place], set[int]] = {}
    for cell in cells:
        seeds.setdefault((cell.agent, (cell.route, cell.sampling_distance)), set()).add(cell.seed)
    return [(agent, place, tuple(sorted(numbers))) for (agent, place), numbers in seeds.items()]


def _seed_shares(seeds: tuple[int, ...], resamples: int, seed: int) -> Float64[np.ndarray, "seeds draws"]:
    """The share of each seed in each resample; equal seeds draw alike, on whichever route and for whichever agent."""
    count = len(seeds)
    if count == 1:
        return np.ones((1, resamples + 1))
    rng = np.random.default_rng([seed, crc32(repr(seeds).encode())])
    drawn = rng.multinomial(count - 1, np.full(count, 1 / count), size=resamples)
    return np.concatenate([np.full((count, 1), 1 / count), drawn.T / (count - 1)], axis=1)
