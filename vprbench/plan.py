"""Which cells of a sweep still have to be measured."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from vprbench.agents import normalise
from vprbench.errors import DataError
from vprbench.provenance import origins
from vprbench.results import ResultTable
from vprbench.sweep import Cell, Sweep

__all__ = ["Plan", "plan"]


@dataclass(frozen=True)
class Plan:
    """The cells asked for, by what is to be done with them.

    Attributes:
        wanted: never finished, or asked for again.
        changed: finished, but with another configuration, plug-in version or data than today's.
        kept: finished; their rows stay.
    """

    wanted: tuple[Cell, ...]
    changed: tuple[Cell, ...]
    kept: tuple[Cell, ...]

    @property
    def todo(self) -> list[Cell]:
        """The cells to measure."""
        return [*self.wanted, *self.changed]


def plan(sweep: Sweep, cells: list[Cell], table: ResultTable, checksum: Callable[[str], str], overwrite: bool) -> Plan:
    """Hold the cells against the rows that are there; `checksum(route)` is that of the data of today."""
    wanted, changed, kept = [], [], []
    for cell in cells:
        row = table.row(cell)
        if row is None or overwrite:
            wanted.append(cell)
        elif _same_agent(sweep, cell, row) and _same_data(row["data_checksum"], cell.route, checksum):
            kept.append(cell)
        else:
            changed.append(cell)
    return Plan(tuple(wanted), tuple(changed), tuple(kept))


def _same_agent(sweep: Sweep, cell: Cell, row: Mapping[str, Any]) -> bool:
    """Whether a row's agent has today's configuration, from today's distributions."""
    config = normalise(sweep.agents[cell.agent])
    return row["agent_config"] == json.dumps(config, sort_keys=True) and row["plugins"] == origins(config)


def _same_data(stored: str, route: str, checksum: Callable[[str], str]) -> bool:
    """Whether a route's data are still those of the row; where they are not here, nothing says otherwise."""
    try:
        return checksum(route) == stored
    except DataError:
        return True
