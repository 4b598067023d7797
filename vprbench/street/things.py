"""What stands in a street: one record for each house, tree, car, pole or mark."""

from __future__ import annotations

from typing import Any

import numpy as np

from vprbench.street.course import Course

__all__ = ["THING", "Things", "place", "stand"]

# Sizes and positions in metres; `forward` is +1 where the object heads along the street and -1 where it
# heads against it; `bright` multiplies the texture.
THING = np.dtype(
    [
        (name, np.int64 if name in ("mesh", "skin") else np.float64)
        for name in (
            *("east", "north", "up", "cos", "sin", "length", "width", "height"),
            *("station", "lateral", "forward", "bright", "mesh", "skin"),
        )
    ]
)
Things = np.ndarray[tuple[int], np.dtype[Any]]


def place(course: Course, rows: list[dict[str, float]]) -> Things:
    """The records of objects given in street coordinates, sorted by station.

    Each row holds station, lateral, length, width, height, mesh and skin; optional are up (0), bright (1)
    and forward (+1; -1 turns the object round).
    """
    rows = sorted(rows, key=lambda row: row["station"])
    things = np.zeros(len(rows), THING)
    for key, default in (("up", 0.0), ("bright", 1.0), ("forward", 1.0)):
        things[key] = [row.get(key, default) for row in rows]
    for key in ("station", "lateral", "length", "width", "height", "mesh", "skin"):
        things[key] = [row[key] for row in rows]
    stand(course, things)
    return things


def stand(course: Course, things: Things) -> None:
    """Set each object's place and direction on the ground plane from its street coordinates."""
    positions = course.world(things["station"], things["lateral"])
    things["east"], things["north"] = positions[:, 0], positions[:, 1]
    heading = course.heading_at(things["station"])
    things["cos"], things["sin"] = np.cos(heading) * things["forward"], np.sin(heading) * things["forward"]
