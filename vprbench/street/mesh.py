"""The few solid shapes of which a street is built, in units of each object's own size.

Local axes: along (the object's heading), across (to its right) and up. A street-side object has its front
at across = 0, turned to the road; a vehicle is centred. Corners go clockwise as seen from outside; the
texture spans corner 0 (top left) to corner 1 (top right) and corner 3 (bottom left).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float64, Int64

__all__ = ["BILLBOARD", "BOX", "CAR", "DECAL", "FLAT_HOUSE", "GABLED_HOUSE", "MESHES", "Meshes"]

Point = tuple[float, float, float]
Face = tuple[int, Point, Point, Point, Point]  # skin slot and corners


class Meshes(NamedTuple):
    """Every face of every mesh; mesh m owns faces first[m] to first[m + 1]."""

    corners: Float64[np.ndarray, "faces 4 3"]
    slots: Int64[np.ndarray, " faces"]
    first: Int64[np.ndarray, " meshes1"]


BILLBOARD, BOX, FLAT_HOUSE, GABLED_HOUSE, CAR, DECAL = range(6)

_RIDGE = 1.45  # height of a gabled roof's ridge over that of its eaves


def _front(slot: int, across: float, low: float, high: float) -> Face:
    return (slot, (0.5, across, high), (-0.5, across, high), (-0.5, across, low), (0.5, across, low))


def _ends(slot: int, left: float, right: float, low: float, high: float) -> tuple[Face, Face]:
    """The faces that look backwards and forwards."""
    return (
        (slot, (-0.5, left, high), (-0.5, right, high), (-0.5, right, low), (-0.5, left, low)),
        (slot, (0.5, right, high), (0.5, left, high), (0.5, left, low), (0.5, right, low)),
    )


def _box() -> list[Face]:
    top = (1, (0.5, 1.0, 1.0), (-0.5, 1.0, 1.0), (-0.5, 0.0, 1.0), (0.5, 0.0, 1.0))
    return [_front(0, 0.0, 0.0, 1.0), *_ends(0, 0.0, 1.0, 0.0, 1.0), top]


def _flat_house() -> list[Face]:
    return [_front(0, 0.0, 0.0, 1.0), *_ends(1, 0.0, 1.0, 0.0, 1.0)]


def _gabled_house() -> list[Face]:
    roof = (2, (0.5, 0.5, _RIDGE), (-0.5, 0.5, _RIDGE), (-0.5, -0.04, 0.98), (0.5, -0.04, 0.98))
    near = (3, (-0.5, 0.5, _RIDGE), (-0.5, 1.0, 1.0), (-0.5, 0.5, 1.0), (-0.5, 0.0, 1.0))
    far = (3, (0.5, 0.5, _RIDGE), (0.5, 0.0, 1.0), (0.5, 0.5, 1.0), (0.5, 1.0, 1.0))
    return [roof, near, far, *_flat_house()]


def _car() -> list[Face]:
    """A cabin upon a body, then its shadow on the ground."""
    waist, base, top, sill = 0.6, 0.46, 0.38, 0.0
    rear, front, rear_top, front_top = -0.44, 0.22, -0.32, 0.04
    cabin: list[Face] = [
        (6, (front_top, -top, 1.0), (front_top, top, 1.0), (rear_top, top, 1.0), (rear_top, -top, 1.0)),
        (5, (rear_top, -top, 1.0), (rear_top, top, 1.0), (rear, base, waist), (rear, -base, waist)),
        (5, (front_top, top, 1.0), (front_top, -top, 1.0), (front, -base, waist), (front, base, waist)),
        (4, (front_top, -top, 1.0), (rear_top, -top, 1.0), (rear, -base, waist), (front, -base, waist)),
        (4, (rear_top, top, 1.0), (front_top, top, 1.0), (front, base, waist), (rear, base, waist)),
    ]
    back, nose = _ends(1, -0.5, 0.5, 0.12, waist)
    body: list[Face] = [
        (3, (0.5, -0.5, waist), (0.5, 0.5, waist), (-0.5, 0.5, waist), (-0.5, -0.5, waist)),
        back,
        (2, *nose[1:]),
        _front(0, -0.5, sill, waist),
        (0, (-0.5, 0.5, waist), (0.5, 0.5, waist), (0.5, 0.5, sill), (-0.5, 0.5, sill)),
        (7, (0.56, -0.62, 0.0), (0.56, 0.62, 0.0), (-0.56, 0.62, 0.0), (-0.56, -0.62, 0.0)),
    ]
    return cabin + body


def _stack(meshes: list[list[Face]]) -> Meshes:
    faces = [face for mesh in meshes for face in mesh]
    first = np.concatenate([[0], np.cumsum([len(mesh) for mesh in meshes])])
    corners = np.array([face[1:] for face in faces], np.float64)
    return Meshes(corners, np.array([face[0] for face in faces], np.int64), first.astype(np.int64))


# A billboard turns to the camera, so that its face stands for width and height alone.
_BILLBOARD: list[Face] = [(0, (0.0, -0.5, 1.0), (0.0, 0.5, 1.0), (0.0, 0.5, 0.0), (0.0, -0.5, 0.0))]
_DECAL: list[Face] = [(0, (0.5, -0.5, 0.0), (0.5, 0.5, 0.0), (-0.5, 0.5, 0.0), (-0.5, -0.5, 0.0))]

MESHES = _stack([_BILLBOARD, _box(), _flat_house(), _gabled_house(), _car(), _DECAL])
