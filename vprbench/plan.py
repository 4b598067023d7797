"""Which cells of a sweep still have to be measured."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass

from vprbench.agents import normalise
from vprbench.errors import DataError
from vprbench.results import ResultTable
from vprbench.sweep import Cell, Sweep

__all__ = ["Plan", "plan"]


@dataclass(frozen=True)
class Plan:
    """The cells asked for, by what is to be done with them.

    Attributes:
        missing: never finished, or asked for again.
        changed: finished, but with another configuration or other data than today's.
        kept: finished; their rows stay.
    """

    missing: tuple[Cell, ...]
    changed: tuple[Cell, ...]
    kept: tuple[Cell, ...]

    @property
    def todo(self) -> list[Cell]:
        """The cells to measure."""
        return [*self.missing, *self.changed]


def plan(sweep: Sweep, cells: list[Cell], table: ResultTable, checksum: Callable[[str], str], overwrite: bool) -> Plan:
    """Hold the cells against the rows that are there; `checksum(route)` is that of the data of today."""
    missing, changed, kept = [], [], []
    for cell in cells:
        row = table.row(cell)
        if row is None or overwrite:
            missing.append(cell)
        elif _asked(sweep, cell) == row["agent_config"] and _unchanged(row["data_checksum"], cell.route, checksum):
            kept.append(cell)
        else:
            changed.append(cell)
    return Plan(tuple(missing), tuple(changed), tuple(kept))


def _asked(sweep: Sweep, cell: Cell) -> str:
    """The configuration of a cell's agent, as rows state it."""
    return json.dumps(normalise(sweep.agents[cell.agent]), sort_keys=True)


def _unchanged(stored: str, route: str, checksum: Callable[[str], str]) -> bool:
    """Whether a route's data are still those of the row; where they are not here, nothing says otherwise."""
    try:
        return checksum(route) == stored
    except DataError:
        return True
