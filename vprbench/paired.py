"""Which of two agents is better, and how sure that is: paired differences on the same queries, from stored traces.

Two agents on one route answer the same queries, and hard stretches of road are hard for both. So each resample scores
both on the same stretches and dictionary seeds (`vprbench.paired_scores`) and takes the difference: what they have in
common cancels. An agent's score is the mean over its cells (route and sampling distance).

The interval is that of the percentiles, widened for the small numbers of blocks and seeds (`bootstrap.widening`).
docs/statistics.md says how often such intervals held the truth. They are of one pair each: of 20 pairs of equal agents
about one is found to differ. For n pairs at once, ask for a level of 1 - 0.05 / n (Bonferroni).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from vprbench.bootstrap import BLOCK_M, LEVEL, RESAMPLES, check_settings, widening
from vprbench.errors import ConfigError, DataError, nearest
from vprbench.paired_scores import PAIRED_METRICS, Draws, Drive, Place, Scored, score_cells
from vprbench.results import ResultTable
from vprbench.sweep import Cell
from vprbench.trace import Trace

__all__ = ["PAIRED_METRICS", "VERDICTS", "compare"]

# What an interval says: it lies above 0, below 0, holds 0, or there is none.
VERDICTS = ("better", "worse", "no difference shown", "too short to say")


def compare(
    answers: ResultTable | Mapping[Cell, Trace],
    metric: str = "auc_all",
    *,
    reference: str | None = None,
    agents: Sequence[str] | None = None,
    block_m: float = BLOCK_M,
    resamples: int = RESAMPLES,
    level: float = LEVEL,
    seed: int = 0,
) -> pd.DataFrame:
    """Differences between agents, over the cells that both answered, one row a pair, the largest first.

    The columns: metric, agent, reference, difference (of the first less the second), low and high (its interval),
    cells (route and distance) and queries (over all routes) that it rests on, seeds and reference_seeds, and the
    verdict, one of `VERDICTS`. Without a reference, the agent of each pair is the one with the higher score.

    Args:
        answers: a result table with its traces, or traces by their cells.
        metric: one of `PAIRED_METRICS`.
        reference: with which each other agent is compared; each pair once where there is none.
        agents: which to compare; all by default.
        block_m: length of a block, metres of road (our choice).
        resamples: how many are drawn (our choice).
        level: of the intervals.
        seed: of the drawing.

    Raises:
        ConfigError: an unknown metric or agent, fewer than two agents, or a senseless setting.
        DataError: two agents have no cell in common, a trace cannot be read, or two traces of a route are not of
            the same queries.
    """
    check_settings(block_m, resamples, level)
    if metric not in PAIRED_METRICS:
        raise ConfigError(f"compare: no metric {metric!r}: {nearest(metric, PAIRED_METRICS)}")
    traces = _stored(answers) if isinstance(answers, ResultTable) else answers
    pairs = _pairs(list(dict.fromkeys(cell.agent for cell in traces)), reference, agents)
    wanted = {agent for pair in pairs for agent in pair}
    asked = {cell: trace for cell, trace in traces.items() if cell.agent in wanted}
    scored, drives = score_cells(asked, metric, block_m, resamples, seed)
    described = _row if reference is not None else _better_first
    table = pd.DataFrame([{"metric": metric, **described(pair, scored, drives, level)} for pair in pairs])
    return table.sort_values("difference", ascending=False, kind="stable", ignore_index=True)


def _stored(table: ResultTable) -> dict[Cell, Trace]:
    """The traces of all finished cells of a table."""
    rows = [row for row in table.frame().to_dict("records") if row["status"] == "ok"]
    cells = [
        Cell(str(row["route"]), str(row["agent"]), float(row["sampling_distance_m"]), int(row["seed"])) for row in rows
    ]
    return {cell: table.trace(cell.id) for cell in cells}


def _pairs(present: list[str], reference: str | None, agents: Sequence[str] | None) -> list[tuple[str, str]]:
    """The pairs to compare: each other agent with the reference, or each with each."""
    asked = list(dict.fromkeys(agents or present))
    for agent in [*asked, *([reference] if reference is not None else [])]:
        if agent not in present:
            raise ConfigError(f"compare: no finished cell of agent {agent!r}: {nearest(agent, present)}")
    others = [agent for agent in asked if agent != reference]
    pairs = [(agent, reference) for agent in others] if reference is not None else list(combinations(asked, 2))
    if not pairs:
        raise ConfigError("compare: there is only one agent; it takes two to differ")
    return pairs


def _better_first(
    pair: tuple[str, str], scored: Mapping[str, Mapping[Place, Scored]], drives: Mapping[str, Drive], level: float
) -> dict[str, Any]:
    """The row of one pair, in the order in which its difference is not negative."""
    row = _row(pair, scored, drives, level)
    return _row(pair[::-1], scored, drives, level) if row["difference"] < 0 else row


def _row(
    pair: tuple[str, str], scored: Mapping[str, Mapping[Place, Scored]], drives: Mapping[str, Drive], level: float
) -> dict[str, Any]:
    """The row of one pair."""
    common = [place for place in scored[pair[0]] if place in scored[pair[1]]]
    if not common:
        raise DataError(f"compare: {pair[0]} and {pair[1]} have no finished cell in common; run the sweep again")
    one, other = ([scored[agent][place] for place in common] for agent in pair)
    routes = [drives[route] for route in dict.fromkeys(route for route, _ in common)]
    draws = np.mean([a.draws - b.draws for a, b in zip(one, other, strict=True)], axis=0)
    factor = widening([drive.blocks for drive in routes], level, _seed_shares(one, other, draws))
    low, high = _interval(draws, factor, level)
    return {
        "agent": pair[0],
        "reference": pair[1],
        "difference": float(draws[0]),
        "low": low,
        "high": high,
        "cells": len(common),
        "queries": sum(drive.queries for drive in routes),
        "seeds": len({seed for cell in one for seed in cell.seeds}),
        "reference_seeds": len({seed for cell in other for seed in cell.seeds}),
        "verdict": _verdict(low, high),
    }


def _seed_shares(one: Sequence[Scored], other: Sequence[Scored], draws: Draws) -> list[tuple[float, float]]:
    """The share of the variance of a difference that comes of dictionary seeds, and its degrees of freedom."""
    a, b = (_by_seed(cells) for cells in (one, other))
    sources = [a - b] if a.index.equals(b.index) else [a, b]
    whole = float(draws[1:].var())
    several = [scores for scores in sources if len(scores) > 1] if whole > 0 else []
    return [(float(scores.var(ddof=1)) / len(scores) / whole, len(scores) - 1.0) for scores in several]


def _by_seed(cells: Sequence[Scored]) -> pd.Series:
    """The mean over cells of each seed that was run in all of them."""
    return pd.DataFrame([cell.seeds for cell in cells]).dropna(axis=1).mean().sort_index()


def _interval(draws: Draws, factor: float, level: float) -> tuple[float, float]:
    """Percentiles of the resampled differences, this much further from the difference itself."""
    difference, bounds = draws[0], np.quantile(draws[1:], [(1 - level) / 2, (1 + level) / 2])
    low, high = difference + factor * (bounds - difference)
    return float(low), float(high)


def _verdict(low: float, high: float) -> str:
    better, worse, none, short = VERDICTS
    if np.isnan(low) or np.isnan(high):
        return short
    return better if low > 0 else worse if high < 0 else none
