"""The street itself: its course, its textures, and what stands along it on all days."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float64

from vprbench.street.course import Course, build_course
from vprbench.street.layout import plan_street
from vprbench.street.mesh import BILLBOARD, FLAT_HOUSE, GABLED_HOUSE
from vprbench.street.parameters import Environment
from vprbench.street.sunlight import Outline, shade_stations
from vprbench.street.things import Thing, Things, place
from vprbench.street.wardrobe import Wardrobe, paint_wardrobe

__all__ = ["Scenery", "build_scenery"]

# How high a house stands in the sun's way, per height of its eaves: a gabled roof slopes away from them.
_WALL_PER_EAVES = {FLAT_HOUSE: 1.0, GABLED_HOUSE: 1.25}


@dataclass(frozen=True)
class Scenery:
    """All that both drives see alike.

    Attributes:
        course: the street's centreline.
        wardrobe: its textures.
        things: what stands in it, sorted by station.
        outline: its houses and trees as casters of shadows.
        ground: (east, north, cos, sin, half the road's width) of every sample of the course.
    """

    course: Course
    wardrobe: Wardrobe
    things: Things
    outline: Outline
    ground: Float64[np.ndarray, "stations 5"]


@lru_cache(maxsize=3)
def build_scenery(environment: Environment, length: float, seed: int) -> Scenery:
    """One street; the same arguments always give the same one."""
    course = build_course(environment, length, seed)
    wardrobe = paint_wardrobe(environment, seed)
    things = plan_street(course, wardrobe.models, np.random.default_rng([seed, 4]))
    half = course.half_road_at(course.stations)
    ground = np.column_stack([course.centre, np.cos(course.heading), np.sin(course.heading), half])
    return Scenery(course, wardrobe, place(course, things), _outline(course, things), ground)


def _outline(course: Course, things: Iterable[Thing]) -> Outline:
    """Distance and height of the houses and of the crowns of trees, all along the street."""
    stations = shade_stations(course)
    wall, crown = np.tile(course.facade_at(stations), (2, 1)), np.tile(course.half_road_at(stations) + 1.5, (2, 1))
    height, low, high = np.zeros_like(wall), np.ones_like(wall), np.zeros_like(wall)
    for thing in things:
        right = int(thing.lateral > 0)
        if thing.mesh in _WALL_PER_EAVES:
            height[right, _span(stations, thing, 0.5 * thing.length)] = thing.height * _WALL_PER_EAVES[thing.mesh]
        elif thing.mesh == BILLBOARD and thing.width > 2.0:
            span = _span(stations, thing, 0.4 * thing.width)
            low[right, span], high[right, span] = thing.height * 0.3, thing.height * 0.95
    return Outline(wall, crown, height, low, high)


def _span(stations: Float64[np.ndarray, " stations"], thing: Thing, reach: float) -> slice:
    """The samples within some metres of a thing."""
    first, last = np.searchsorted(stations, (thing.station - reach, thing.station + reach))
    return slice(first, last)
