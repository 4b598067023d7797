"""What agents answered in a study, on the roads that a claim speaks of or on those that stand in for them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass
from pathlib import Path

from vprbench.claims.reading import Evidence, Untestable, canonical
from vprbench.results import ResultTable
from vprbench.sweep import Cell
from vprbench.trace import Trace

__all__ = ["Answers", "find_answers"]


@dataclass(frozen=True)
class Answers:
    """Traces by their cells, agents under their canonical names, on roads where all of these agents were measured.

    Attributes:
        traces: at least one for each agent.
        measured_on: the roads in words.
        at_home: whether they are all that the claim speaks of.
    """

    traces: dict[Cell, Trace]
    measured_on: str
    at_home: bool


def find_answers(
    evidence: Evidence,
    study: str,
    routes: Sequence[str],
    agents: Sequence[str],
    *,
    distances: Sequence[float] = (),
    least: int = 1,
) -> Answers:
    """The traces of STUDY.csv, or of STUDY-*.csv where a study was measured in parts.

    Args:
        evidence: where to look.
        study: name of the sweep.
        routes: that the claim speaks of.
        agents: canonical names.
        distances: sampling distances to keep, metres; all by default.
        least: how many roads there must be.

    Raises:
        Untestable: a table, an agent, a distance or a road is missing.
    """
    stored = {
        cell: file
        for cell, file in _stored(evidence, study).items()
        if cell.agent in agents and (not distances or cell.sampling_distance in distances)
    }
    where = f" at {' and '.join(f'{distance:g} m' for distance in distances)}" if distances else ""
    for agent in agents:
        if all(cell.agent != agent for cell in stored):
            raise Untestable(f"{study} has no finished cell of {agent}{where}")
    chosen, words, at_home = _choose(routes, _shared_roads(stored, agents), evidence.stand_ins, least)
    traces = {cell: Trace.load(file) for cell, file in stored.items() if cell.route in chosen}
    return Answers(traces, words, at_home)


def _shared_roads(cells: Iterable[Cell], agents: Iterable[str]) -> set[str]:
    """The roads where all of these agents were measured."""
    found = {(cell.route, cell.agent) for cell in cells}
    return {route for route, _ in found if all((route, agent) in found for agent in agents)}


def _stored(evidence: Evidence, study: str) -> dict[Cell, Path]:
    """The finished cells of a study, agents under their canonical names, and where the trace of each one lies."""
    paths = [evidence.folder / f"{study}.csv", *sorted(evidence.folder.glob(f"{study}-*.csv"))]
    tables = [ResultTable(evidence.folder, path.stem) for path in paths if path.exists()]
    if not tables:
        raise Untestable(f"no {study}.csv: vprbench sweep {study} makes it")
    return {cell: file for table in reversed(tables) for cell, file in _finished(table).items()}


def _finished(table: ResultTable) -> dict[Cell, Path]:
    """The finished cells of one table, and their traces."""
    rows = [row for row in table.frame().to_dict("records") if row["status"] == "ok"]
    return {
        Cell(
            str(row["route"]), canonical(str(row["agent"])), float(row["sampling_distance_m"]), int(row["seed"])
        ): table.trace_path(str(row["cell"]))
        for row in rows
    }


def _choose(
    routes: Sequence[str], measured: Set[str], stand_ins: Sequence[Sequence[str]], least: int
) -> tuple[list[str], str, bool]:
    """The roads to judge by: the claim's own, those of them that there are, or the first stand-ins that there are."""
    own = [route for route in routes if route in measured]
    if own and len(own) == len(routes):
        return own, ", ".join(own), True
    groups = [(own, "part of the routes: ")]
    groups += [([route for route in group if route in measured], "stand-in: ") for group in stand_ins]
    for group, label in groups:
        if len(group) >= least:
            return group, label + ", ".join(group), False
    found = ", ".join(sorted(measured)) or "none"
    raise Untestable(f"{', '.join(routes)} not measured, nor {least} that could stand in (measured: {found})")
