"""The painter of solid things: projects every face in sight and hands it to the filler, nearest first."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vprbench.street.canvas import Canvas, View
from vprbench.street.face import cross
from vprbench.street.fill import fill
from vprbench.street.mesh import BILLBOARD, CAR, Meshes
from vprbench.street.pixels import no_pixels
from vprbench.street.sunlight import Sunlight
from vprbench.street.texture import Skins
from vprbench.street.things import Things

__all__ = ["nearest_first", "paint_things"]

_NEAR = 0.4  # metres: nothing nearer to the camera is drawn


def nearest_first(view: View, things: Things) -> Things:
    """The things ahead of the camera, in the order in which they hide each other.

    What lines the street, seen at a slant, goes by its farthest point: all that stands before it is nearer.
    Cars go by their nearest: all that stands beside them, off the road, is behind.
    """
    east, north = things["east"] - view.east, things["north"] - view.north
    along = np.abs(things["sin"] * view.sin + things["cos"] * view.cos) * things["length"] / 2
    across = np.abs(things["cos"] * view.sin - things["sin"] * view.cos) * things["width"]
    reach = np.where(things["mesh"] == BILLBOARD, 0.0, along + across)
    centre = east * view.sin + north * view.cos
    order = np.argsort(centre + np.where(things["mesh"] == CAR, -reach, reach), kind="stable")
    return things[order[(centre + reach)[order] > _NEAR]]


@njit(cache=True, error_model="numpy")
def paint_things(canvas: Canvas, view: View, things: Things, meshes: Meshes, skins: Skins, sunlight: Sunlight) -> None:
    """Paint all things in the order given: nearest first."""
    corners, polygon, edges, surface = np.empty((4, 3)), np.empty((5, 3)), np.empty((5, 3)), np.empty((4, 3))
    pixels = no_pixels()
    for k in range(things.size):
        thing = things[k]
        for face in range(meshes.first[thing.mesh], meshes.first[thing.mesh + 1]):
            _to_camera(view, thing, meshes.corners[face], corners)
            count = _clip(corners, polygon)
            if count >= 3 and _project(view, polygon, count, edges):
                skin = skins.table[thing.skin + meshes.slots[face]]
                _light(thing, meshes.corners[face], sunlight, surface)
                fill(
                    canvas, pixels, view, polygon[:count], edges[:count], corners, skins.texels, skin, surface, sunlight
                )


@njit(cache=True, error_model="numpy")
def _to_camera(view: View, thing: np.record, local: NDArray[np.float64], corners: NDArray[np.float64]) -> None:
    """The corners of a face in camera axes: right, down, ahead."""
    east, north = thing.east - view.east, thing.north - view.north
    right, ahead = east * view.cos - north * view.sin, east * view.sin + north * view.cos
    turn_cos, turn_sin = thing.cos * view.cos + thing.sin * view.sin, thing.sin * view.cos - thing.cos * view.sin
    if thing.mesh == BILLBOARD:
        turn_cos, turn_sin = 1.0, 0.0
    for i in range(4):
        a, b = local[i, 0] * thing.length, local[i, 1] * thing.width
        corners[i, 0] = right + a * turn_sin + b * turn_cos
        corners[i, 1] = view.up - thing.up - local[i, 2] * thing.height
        corners[i, 2] = ahead + a * turn_cos - b * turn_sin


@njit(cache=True, error_model="numpy")
def _clip(corners: NDArray[np.float64], polygon: NDArray[np.float64]) -> int:
    """Cut the face off at the near plane; how many corners are left."""
    count = 0
    for i in range(4):
        j = (i + 1) & 3
        here, there = corners[i, 2], corners[j, 2]
        if here >= _NEAR:
            polygon[count, 0], polygon[count, 1], polygon[count, 2] = corners[i, 0], corners[i, 1], corners[i, 2]
            count += 1
        if (here >= _NEAR) != (there >= _NEAR):
            t = (_NEAR - here) / (there - here)
            for axis in range(3):
                polygon[count, axis] = corners[i, axis] + t * (corners[j, axis] - corners[i, axis])
            count += 1
    return count


@njit(cache=True, error_model="numpy")
def _project(view: View, polygon: NDArray[np.float64], count: int, edges: NDArray[np.float64]) -> bool:
    """Corners to pixels and edges to lines a x + b y + c (pixels inside); False if seen from behind."""
    area = 0.0
    for i in range(count):
        polygon[i, 0] = view.cx + view.fx * polygon[i, 0] / polygon[i, 2]
        polygon[i, 1] = view.cy + view.fy * polygon[i, 1] / polygon[i, 2]
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        x, y = polygon[i, 0], polygon[i, 1]
        dx, dy = polygon[j, 0] - x, polygon[j, 1] - y
        area += x * dy - y * dx
        length = np.sqrt(dx * dx + dy * dy)
        if length < 1e-6:
            edges[i, 0] = edges[i, 1] = edges[i, 2] = 0.0  # two corners in one place bound nothing
            continue
        edges[i, 0], edges[i, 1] = -dy / length, dx / length
        edges[i, 2] = (x * dy - y * dx) / length
    return area > 0.0


@njit(cache=True, error_model="numpy")
def _light(thing: np.record, local: NDArray[np.float64], sunlight: Sunlight, surface: NDArray[np.float64]) -> None:
    """How a face takes light: (in the shade, added by the sun) and its street coordinates at, per u, per v."""
    size = (thing.length, thing.width, thing.height)
    for axis in range(3):
        surface[1, axis] = local[0, axis] * size[axis]
        surface[2, axis] = (local[1, axis] - local[0, axis]) * size[axis]
        surface[3, axis] = (local[3, axis] - local[0, axis]) * size[axis]
    surface[0, 0], surface[0, 1] = 0.75, 0.6
    if thing.mesh == BILLBOARD:
        surface[2, 0] = thing.width  # as if it lay along the street, to be dappled both ways
    else:
        along, across, up = cross(surface[3], surface[2])
        length = np.sqrt(along * along + across * across + up * up)
        east, north = along * thing.sin + across * thing.cos, along * thing.cos - across * thing.sin
        facing = east * sunlight.toward[0] + north * sunlight.toward[1] + up * sunlight.toward[2]
        surface[0, 0], surface[0, 1] = 0.75 + 0.25 * up / length, max(facing / length, 0.0)
    surface[0, 0] *= thing.bright
    surface[0, 1] *= thing.bright * sunlight.direct
    for row in range(1, 4):
        surface[row, 0] *= thing.forward
        surface[row, 1] *= thing.forward
    surface[1, 0] += thing.station
    surface[1, 1] += thing.lateral
    surface[1, 2] += thing.up
