"""What stands in a street: one record for each house, tree, car, post or mark."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vprbench.street.course import Course

__all__ = ["Thing", "Things", "place", "stand"]


class Thing(NamedTuple):
    """One object in street coordinates, metres.

    Attributes:
        mesh: which of the meshes it is, and `skin` its first texture.
        station, lateral, up: where it stands.
        length, width, height: its size along, across and upwards.
        forward: +1 where it heads along the street, -1 where it is turned round.
        bright: multiplies its texture.
    """

    mesh: int
    skin: int
    station: float
    lateral: float
    length: float = 0.0
    width: float = 1.0
    height: float = 1.0
    up: float = 0.0
    forward: float = 1.0
    bright: float = 1.0


# The records of things, with their place (east, north, metres) and direction (cos, sin) on the ground plane.
Things = np.ndarray[tuple[int], np.dtype[np.void]]
_RECORD = np.dtype(
    [(name, np.int64 if name in ("mesh", "skin") else np.float64) for name in Thing._fields]
    + [(name, np.float64) for name in ("east", "north", "cos", "sin")]
)


def place(course: Course, things: Sequence[Thing]) -> Things:
    """The records of things, in the order of their stations."""
    ordered = sorted(things, key=lambda thing: thing.station)
    records = np.zeros(len(ordered), _RECORD)
    for name in Thing._fields:
        records[name] = [getattr(thing, name) for thing in ordered]
    stand(course, records)
    return records


def stand(course: Course, records: Things) -> None:
    """Set the place and direction of every record from its street coordinates."""
    positions, heading = course.world(records["station"], records["lateral"]), course.heading_at(records["station"])
    records["east"], records["north"] = positions[:, 0], positions[:, 1]
    records["cos"], records["sin"] = np.cos(heading) * records["forward"], np.sin(heading) * records["forward"]
