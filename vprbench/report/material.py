"""All that a report is made from: the rows, the question, the traces and the roads of one sweep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import pandas as pd

from vprbench.figures.panels import Run, distinct
from vprbench.figures.style import agent_colours
from vprbench.route import Route

__all__ = ["Absence", "Material", "Question"]


class Absence(NamedTuple):
    """Why a road is not here: for the page, which others read too, and for whoever writes it, with paths and remedy."""

    why: str
    remedy: str


@dataclass(frozen=True)
class Question:
    """The TOML of a sweep: its text, and what it says; both empty where it does not lie beside the results."""

    text: str
    says: Mapping[str, Any]

    @property
    def description(self) -> str:
        """What the sweep asks, in a sentence."""
        return str(self.says.get("description", ""))


@dataclass(frozen=True, eq=False)
class Material:
    """What there is to report of one sweep.

    Attributes:
        name: of the sweep.
        rows: its result table, one row a cell; at least one.
        question: its TOML.
        runs: every finished cell whose trace can be read, in the order of the rows.
        faults: why the trace of a finished cell cannot be read.
        routes: the roads whose data are here, and are those that were measured.
        absent: why another road is not among them.
        appendices: further tables that lie beside the results, by what they are called.
    """

    name: str
    rows: pd.DataFrame
    question: Question
    runs: Sequence[Run]
    faults: Mapping[str, str]
    routes: Mapping[str, Route]
    absent: Mapping[str, Absence]
    appendices: Mapping[str, pd.DataFrame]

    @property
    def finished(self) -> pd.DataFrame:
        """The rows of the cells that were measured."""
        return self.rows[self.rows["status"] == "ok"]

    @property
    def failed(self) -> pd.DataFrame:
        """The rows of the others."""
        return self.rows[self.rows["status"] != "ok"]

    @property
    def agents(self) -> list[str]:
        """The name of every agent, in the order of the rows."""
        return distinct(self.rows["agent"])

    @property
    def distances(self) -> list[float]:
        """Every sampling distance, metres."""
        return sorted(set(self.rows["sampling_distance_m"]))

    @cached_property
    def colours(self) -> dict[str, str]:
        """The colour that an agent keeps throughout the report."""
        return agent_colours(self.agents)

    @property
    def first_runs(self) -> list[Run]:
        """The runs, of several seeds only the first."""
        firsts: dict[tuple[str, float, str], Run] = {}
        for run in self.runs:
            firsts.setdefault((run.route, run.distance, run.agent), run)
        return list(firsts.values())
