"""The painter: projects every face in sight and fills it, nearest first.

A canvas keeps, beside the light that has reached each pixel, how clear the pixel still is: what lies
nearer has taken its share, and what lies behind paints only the rest. So every pixel is filled about once,
and edges and leaves blend with whatever is behind them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32
from numba import njit

from vprbench.street.mesh import BILLBOARD
from vprbench.street.sunlight import lit
from vprbench.street.texture import sample

__all__ = ["Canvas", "View", "paint_things"]

_NEAR = 0.4  # metres: nothing nearer to the camera is drawn
OPAQUE = 0.004  # a pixel no clearer than this is full


class View(NamedTuple):
    """A pinhole camera somewhere in the street: sizes in pixels, place in metres.

    Attributes:
        fx, fy: focal lengths.
        cx, cy: principal point; the vehicle's pitch moves cy.
        east, north, up: where the camera is.
        cos, sin: of its heading, clockwise from north.
        station, lateral: the same place in street coordinates.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    east: float
    north: float
    up: float
    cos: float
    sin: float
    station: float
    lateral: float


class Canvas(NamedTuple):
    """A frame being painted: the light so far, and how clear each pixel still is (1..0)."""

    light: Float32[np.ndarray, "height width"]
    clear: Float32[np.ndarray, "height width"]

    @classmethod
    def blank(cls, height: int, width: int) -> Canvas:
        """A canvas on which nothing is painted."""
        return cls(np.zeros((height, width), np.float32), np.ones((height, width), np.float32))


@njit(cache=True, error_model="numpy")
def paint_things(canvas, view, things, meshes, skins, sunlight):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN201
    """Paint all things, nearest first by their farthest point (which suits walls seen at a slant)."""
    depths = np.empty(things.size)
    for k in range(things.size):
        depths[k] = _depth(view, things[k])
    corners, polygon, edges = np.empty((4, 3)), np.empty((6, 3)), np.empty((6, 3))
    for k in np.argsort(depths, kind="mergesort"):
        if depths[k] < _NEAR:
            continue
        thing = things[k]
        for face in range(meshes.first[thing.mesh], meshes.first[thing.mesh + 1]):
            _to_camera(view, thing, meshes.corners[face], corners)
            count = _clip(corners, polygon)
            if count < 3 or not _project(view, polygon, count, edges):
                continue
            skin = skins.table[thing.skin + meshes.slots[face]]
            surface = _surface(thing, meshes.corners[face], sunlight)
            _fill(canvas, view, polygon, edges, count, corners, skins.texels, skin, surface, sunlight)


@njit(cache=True, error_model="numpy")
def _depth(view, thing):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
    """Distance ahead of the farthest corner of a thing's footprint."""
    centre = (thing.east - view.east) * view.sin + (thing.north - view.north) * view.cos
    if thing.mesh == BILLBOARD:
        return centre
    along = abs(thing.sin * view.sin + thing.cos * view.cos) * thing.length * 0.5
    across = abs(thing.cos * view.sin - thing.sin * view.cos) * thing.width
    return centre + along + across


@njit(cache=True, error_model="numpy")
def _to_camera(view, thing, local, corners):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
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
def _clip(corners, polygon):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
    """Cut the face off at the near plane; how many corners are left."""
    count = 0
    for i in range(4):
        here, there = corners[i], corners[(i + 1) & 3]
        if here[2] >= _NEAR:
            polygon[count] = here
            count += 1
        if (here[2] >= _NEAR) != (there[2] >= _NEAR):
            t = (_NEAR - here[2]) / (there[2] - here[2])
            polygon[count] = here + t * (there - here)
            count += 1
    return count


@njit(cache=True, error_model="numpy")
def _project(view, polygon, count, edges):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
    """Corners to pixels and edges to lines a x + b y + c (pixels inside); False if seen from behind."""
    area = 0.0
    for i in range(count):
        polygon[i, 0] = view.cx + view.fx * polygon[i, 0] / polygon[i, 2]
        polygon[i, 1] = view.cy + view.fy * polygon[i, 1] / polygon[i, 2]
    for i in range(count):
        p, q = polygon[i], polygon[(i + 1) % count]
        dx, dy = q[0] - p[0], q[1] - p[1]
        area += p[0] * q[1] - q[0] * p[1]
        length = max(np.sqrt(dx * dx + dy * dy), 1e-6)
        edges[i, 0], edges[i, 1] = -dy / length, dx / length
        edges[i, 2] = (p[0] * dy - p[1] * dx) / length
        if length < 1e-5:
            edges[i, 2] = 1e6
    return area > 0.0


@njit(cache=True, error_model="numpy")
def _surface(thing, local, sunlight):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
    """How a face takes light: shade, sun, and its street coordinates at, per u and per v."""
    size = np.array([thing.length, thing.width, thing.height])
    u, v = (local[1] - local[0]) * size, (local[3] - local[0]) * size
    normal = np.cross(v, u)
    normal /= np.sqrt((normal * normal).sum())
    east = normal[0] * thing.sin + normal[1] * thing.cos
    north = normal[0] * thing.cos - normal[1] * thing.sin
    facing = east * sunlight.toward[0] + north * sunlight.toward[1] + normal[2] * sunlight.toward[2]
    surface = np.empty((4, 3))
    if thing.mesh == BILLBOARD:
        facing, u, v = 0.6, np.zeros(3), np.array([0.0, 0.0, -thing.height])
    surface[0, 0] = thing.bright * (0.75 + 0.25 * normal[2])
    surface[0, 1] = thing.bright * sunlight.direct * max(facing, 0.0)
    at = local[0] * size
    surface[1] = thing.station + at[0] * thing.forward, thing.lateral + at[1] * thing.forward, thing.up + at[2]
    surface[2] = u[0] * thing.forward, u[1] * thing.forward, u[2]
    surface[3] = v[0] * thing.forward, v[1] * thing.forward, v[2]
    return surface


@njit(cache=True, error_model="numpy")
def _fill(canvas, view, polygon, edges, count, corners, texels, skin, surface, sunlight):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
    """Paint the pixels of one face, each through the clearness that is left."""
    top, bottom = polygon[:count, 1].min() - 0.5, polygon[:count, 1].max() + 0.5
    u_axis, v_axis = corners[1] - corners[0], corners[3] - corners[0]
    nu, nv, nw = np.cross(v_axis, corners[0]), np.cross(corners[0], u_axis), np.cross(u_axis, v_axis)
    # Half a pixel of softness runs far out at a sharp corner: the corners themselves bound it.
    outer_left, outer_right = (
        max(polygon[:count, 0].min() - 0.5, 0.0),
        min(polygon[:count, 0].max() + 0.5, view.width - 1.0),
    )
    for y in range(max(int(np.ceil(top)), 0), min(int(bottom), view.height - 1) + 1):
        left, right = outer_left, outer_right
        for i in range(count):
            rest = edges[i, 1] * y + edges[i, 2] + 1.0
            if edges[i, 0] > 1e-9:
                left = max(left, -rest / edges[i, 0])
            elif edges[i, 0] < -1e-9:
                right = min(right, -rest / edges[i, 0])
            elif rest <= 0.0:
                right = -1.0
        ry = (y - view.cy) / view.fy
        for x in range(int(np.ceil(left)), int(np.floor(right)) + 1):
            clear = canvas.clear[y, x]
            if clear <= OPAQUE:
                continue
            cover = 1.0
            for i in range(count):
                cover = min(cover, edges[i, 0] * x + edges[i, 1] * y + edges[i, 2] + 1.0)
            rx = (x - view.cx) / view.fx
            w = 1.0 / (nw[0] * rx + nw[1] * ry + nw[2])
            u, v = (nu[0] * rx + nu[1] * ry + nu[2]) * w, (nv[0] * rx + nv[1] * ry + nv[2]) * w
            wx, wy = w / view.fx, w / view.fy
            du = abs(nu[0] - u * nw[0]) * wx + abs(nu[1] - u * nw[1]) * wy
            dv = abs(nv[0] - v * nw[0]) * wx + abs(nv[1] - v * nw[1]) * wy
            luma, alpha = sample(texels, skin, u, v, du, dv)
            share = surface[0, 1]
            if share > 0.0 and alpha > 0.0:
                station = surface[1, 0] + u * surface[2, 0] + v * surface[3, 0]
                lateral = surface[1, 1] + u * surface[2, 1] + v * surface[3, 1]
                share *= lit(sunlight, station, lateral, surface[1, 2] + u * surface[2, 2] + v * surface[3, 2])
            part = clear * max(cover, 0.0) / 255.0
            canvas.light[y, x] += part * luma * (surface[0, 0] + share)
            canvas.clear[y, x] = clear - part * alpha
