"""What was asked, of whom, and where."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from vprbench.errors import DataError
from vprbench.figures.panels import distinct
from vprbench.report.markup import fragment
from vprbench.report.material import Material
from vprbench.report.section import Section

__all__ = ["question"]


def question(material: Material) -> Section:
    """Routes, sampling distances, agents and their configurations."""
    rows = material.rows
    routes = [_route(group) for _, group in rows.groupby("route", sort=False)]
    agents = [
        {
            "name": agent,
            "colour": material.colours[agent],
            "says": list(_configured(rows["agent_config"][rows["agent"] == agent].iloc[0])),
            "seeds": ", ".join(map(str, sorted(set(rows["seed"][rows["agent"] == agent])))),
        }
        for agent in material.agents
    ]
    values = {"routes": routes, "agents": agents, "distances": _either(material.distances)}
    return Section("What was asked", fragment("question", **values))


def _either(distances: Sequence[float]) -> str:
    """Distances as words: "2, 3 or 5 m"."""
    *most, last = [f"{distance:g}" for distance in distances]
    return f"{', '.join(most)} or {last} m" if most else f"{last} m"


def _route(group: Any) -> dict[str, str]:  # noqa: ANN401 - a group of rows
    """What the rows say of a route, where any of its cells was measured."""
    known = group[group["status"] == "ok"]
    told = {"name": str(group["route"].iloc[0]), "environment": "", "learn": "", "queries": "", "tolerance": ""}
    if known.empty:
        return told
    first = known.iloc[0]
    return told | {
        "environment": str(first["environment"]),
        "learn": f"{first['learn_frames']}",
        "queries": f"{first['queries']}",
        "tolerance": f"{first['tolerance_mean_m']:.2f}",
    }


def _configured(config: str) -> Iterator[str]:
    """An agent's parts and options as words, the localizer first."""
    try:
        table = json.loads(config) if config else {}
    except ValueError as error:
        raise DataError(f"agent_config {config!r} of the results is no JSON; measure its cells again") from error
    for kind in distinct(["localizer", *table]):
        part = table.get(kind)
        if isinstance(part, dict):
            options = ", ".join(f"{key} {value}" for key, value in part.items() if key != "name")
            part = f"{part.get('name', '')}{f' ({options})' if options else ''}"
        if part is not None:
            yield f"{kind} {part}"
