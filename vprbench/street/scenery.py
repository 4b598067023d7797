"""The street itself: where its houses, hedges, trees, posts and marks stand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float64

from vprbench.street.course import BEHIND, SPACING, Course, build_course
from vprbench.street.mesh import BILLBOARD, BOX, DECAL, FLAT_HOUSE, GABLED_HOUSE
from vprbench.street.parameters import Environment
from vprbench.street.sunlight import CROWN_HIGH, CROWN_LATERAL, CROWN_LOW, WALL_HEIGHT, WALL_LATERAL, Outline
from vprbench.street.things import Things, place
from vprbench.street.wardrobe import Wardrobe, paint_wardrobe

__all__ = ["Scenery", "build_scenery", "half_width"]

Row = dict[str, float]

# Half the width of the road and the distance of the facades from its middle, where wide and where narrow.
_ROAD = (5.6, 3.8)
_FACADE = (14.0, 6.2)


@dataclass(frozen=True)
class Scenery:
    """All that both drives see alike.

    Attributes:
        course: the street's centreline.
        wardrobe: its textures.
        things: what stands in it, sorted by station.
        outline: its houses and trees as casters of shadows.
    """

    course: Course
    wardrobe: Wardrobe
    things: Things
    outline: Outline


@lru_cache(maxsize=4)
def build_scenery(environment: Environment, length: float, seed: int) -> Scenery:
    """One street; the same arguments always give the same one."""
    course = build_course(environment, length, seed)
    wardrobe = paint_wardrobe(environment, seed)
    rng = np.random.default_rng([seed, 4])
    rows: list[Row] = []
    for side in (-1.0, 1.0):
        rows += _houses(course, wardrobe, rng, side)
        rows += _trees(course, wardrobe, rng, side)
        rows += _posts(course, wardrobe, rng, side)
    rows += _marks(course, wardrobe, rng)
    return Scenery(course, wardrobe, place(course, rows), _outline(course, rows))


def half_width(course: Course, station: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, " n"]:
    """Half the width of the road, metres."""
    return _blend(_ROAD, course.narrowness_at(station))


def _blend(values: tuple[float, float], narrowness: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, " n"]:
    return values[0] + (values[1] - values[0]) * narrowness


def _houses(course: Course, wardrobe: Wardrobe, rng: np.random.Generator, side: float) -> list[Row]:
    """A row of houses; in a wide street they stand apart behind hedges, in a narrow one wall to wall."""
    rows: list[Row] = []
    at, end, model = -BEHIND, course.stations[-1], 0
    while at < end:
        narrow = course.narrowness_at(np.array(at)) > 0.5
        length = rng.uniform(8.0, 13.0) if narrow else rng.uniform(11.0, 17.0)
        middle = at + length / 2
        front = float(_blend(_FACADE, course.narrowness_at(np.array(middle)))) + rng.uniform(-0.3, 0.3)
        if rng.random() > 0.4:
            model = int(rng.integers(0, len(wardrobe.models["house"])))
        gabled = model % 3 > 0
        rows.append(
            _row(middle, side * front, length, 10.0, rng.uniform(7.0, 11.0), GABLED_HOUSE if gabled else FLAT_HOUSE)
            | {"skin": wardrobe.models["house"][model], "forward": side, "bright": rng.uniform(0.8, 1.2)}
        )
        gap = (rng.uniform(2.5, 9.0) if rng.random() < 0.2 else 0.0) if narrow else rng.uniform(4.0, 9.0)
        if not narrow and rng.random() < 0.6:
            skin = int(rng.choice(wardrobe.models["hedge"]))
            hedge = float(half_width(course, np.array(middle))) + 2.6
            rows.append(
                _row(middle, side * hedge, length, 0.8, rng.uniform(0.8, 1.6), BOX) | {"skin": skin, "forward": side}
            )
        at += length + gap
    return rows


def _trees(course: Course, wardrobe: Wardrobe, rng: np.random.Generator, side: float) -> list[Row]:
    """Trees by the kerb of a wide street, few in a narrow one; bushes before the houses."""
    rows: list[Row] = []
    at, end = -BEHIND + 3, course.stations[-1]
    while at < end:
        narrow = float(course.narrowness_at(np.array(at)))
        kerb = float(half_width(course, np.array(at)))
        if narrow < 0.5 and rng.random() < 0.7:
            kind = "conifer" if rng.random() < 0.25 else "tree"
            height = rng.uniform(5.0, 9.0)
            lateral = kerb + rng.uniform(1.0, 4.0)
            rows.append(
                _row(at, side * lateral, 0.0, height * rng.uniform(0.7, 1.0), height, BILLBOARD)
                | {"skin": int(rng.choice(wardrobe.models[kind])), "bright": rng.uniform(0.7, 1.2)}
            )
            size = rng.uniform(1.2, 2.8)
            rows.append(
                _row(at + rng.uniform(-4, 4), side * (kerb + rng.uniform(3.0, 6.0)), 0.0, size * 1.3, size, BILLBOARD)
                | {"skin": int(rng.choice(wardrobe.models["bush"])), "bright": rng.uniform(0.7, 1.2)}
            )
        elif rng.random() < 0.15:
            rows.append(
                _row(at, side * (kerb + 1.2), 0.0, 3.0, 4.5, BILLBOARD)
                | {"skin": int(rng.choice(wardrobe.models["tree"]))}
            )
        at += rng.uniform(6.0, 13.0)
    return rows


def _posts(course: Course, wardrobe: Wardrobe, rng: np.random.Generator, side: float) -> list[Row]:
    rows: list[Row] = []
    at, end = -BEHIND, course.stations[-1]
    while at < end:
        at += rng.uniform(10.0, 25.0)
        lateral = side * (float(half_width(course, np.array(at))) + 0.5)
        lamp = rng.random() < 0.4
        size = (1.6, 6.5) if lamp else (0.65, 2.6)
        skin = int(rng.choice(wardrobe.models["lamp" if lamp else "sign"]))
        rows.append(_row(at, lateral, 0.0, *size, BILLBOARD) | {"skin": skin})
    return rows


def _marks(course: Course, wardrobe: Wardrobe, rng: np.random.Generator) -> list[Row]:
    """Patches, cracks and manholes in the road."""
    rows: list[Row] = []
    for at in np.arange(-BEHIND, course.stations[-1], 4.0):
        half = float(half_width(course, np.array(at)))
        row = _row(at, rng.uniform(-half, half), rng.uniform(0.6, 3.0), rng.uniform(0.6, 1.4), 1.0, DECAL)
        rows.append(row | {"skin": int(rng.choice(wardrobe.models["mark"]))})
    return rows


def _row(station: float, lateral: float, length: float, width: float, height: float, mesh: int) -> Row:
    return {
        "station": station,
        "lateral": lateral,
        "length": length,
        "width": width,
        "height": height,
        "mesh": mesh,
    }


def _outline(course: Course, rows: list[Row]) -> Outline:
    """Height and distance of the houses, and of the crowns of trees, at every sample of the course."""
    outline = np.zeros((2, len(course.heading), 5))
    outline[:, :, WALL_LATERAL] = _blend(_FACADE, course.narrowness)
    outline[:, :, CROWN_LATERAL] = _blend(_ROAD, course.narrowness) + 1.5
    for row in rows:
        side = outline[int(row["lateral"] > 0)]
        reach = row["length"] / 2 if row["mesh"] in (FLAT_HOUSE, GABLED_HOUSE) else row["width"] * 0.4
        first, last = (round((row["station"] + sign * reach + BEHIND) / SPACING) for sign in (-1, 1))
        span = slice(max(first, 0), max(last, 0))
        if row["mesh"] in (FLAT_HOUSE, GABLED_HOUSE):
            side[span, WALL_HEIGHT] = row["height"] * (1.25 if row["mesh"] == GABLED_HOUSE else 1.0)
        elif row["mesh"] == BILLBOARD and row["width"] > 2.0:
            side[span, CROWN_LOW], side[span, CROWN_HIGH] = row["height"] * 0.3, row["height"] * 0.95
    return outline
