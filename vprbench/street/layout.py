"""The plan of a street: which house, hedge, tree, post or mark stands where; all sizes are our choice."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import numpy as np
from jaxtyping import Float64

from vprbench.street.course import BEHIND, Course
from vprbench.street.mesh import BILLBOARD, BOX, DECAL, FLAT_HOUSE, GABLED_HOUSE
from vprbench.street.things import Thing

__all__ = ["plan_street"]

Models = Mapping[str, tuple[int, ...]]

_ALIKE = 0.4  # share of houses built like their neighbour


def plan_street(course: Course, models: Models, rng: np.random.Generator) -> list[Thing]:
    """Everything that stands still on all days.

    Args:
        course: the street's centreline.
        models: the first texture of every model of each kind.
        rng: decides where the course leaves a choice.
    """
    things: list[Thing] = []
    for side in (-1.0, 1.0):
        things += _row_of_houses(course, models, rng, side)
        things += _kerbside_plants(course, models, rng, side)
        things += _posts(course, models, rng, side)
    return [*things, *_marks(course, models, rng)]


def _row_of_houses(course: Course, models: Models, rng: np.random.Generator, side: float) -> Iterator[Thing]:
    """Houses wall to wall where it is narrow; apart, with hedges and trees between them, where it is wide."""
    at, model = -BEHIND, 0
    while at < course.stations[-1]:
        narrow = _at(course.narrowness_at, at) > 0.5
        length = rng.uniform(8.0, 13.0) if narrow else rng.uniform(11.0, 17.0)
        gap = (rng.uniform(2.5, 9.0) if rng.random() < 0.2 else 0.0) if narrow else rng.uniform(4.0, 9.0)
        if rng.random() > _ALIKE:
            model = int(rng.integers(0, len(models["house"])))
        house = _house(course, models, rng, at + length / 2, length, model, side)
        yield house
        if not narrow and rng.random() < 0.6:
            yield _hedge(course, models, rng, house)
        if gap > 3.0:
            lateral = abs(house.lateral) + rng.uniform(4.0, 14.0)
            yield _plant(models, rng, "tree", at + length + gap / 2, side * lateral, rng.uniform(5.0, 9.0))
        at += length + gap


def _house(
    course: Course, models: Models, rng: np.random.Generator, station: float, length: float, model: int, side: float
) -> Thing:
    return Thing(
        mesh=GABLED_HOUSE if model % 3 else FLAT_HOUSE,
        skin=models["house"][model],
        station=station,
        lateral=side * (_at(course.facade_at, station) + rng.uniform(-0.3, 0.3)),
        length=length,
        width=10.0,
        height=rng.uniform(7.0, 11.0),
        forward=side,
        bright=rng.uniform(0.8, 1.2),
    )


def _hedge(course: Course, models: Models, rng: np.random.Generator, house: Thing) -> Thing:
    """A hedge between a house and the pavement."""
    return house._replace(
        mesh=BOX,
        skin=int(rng.choice(models["hedge"])),
        lateral=house.forward * (_at(course.half_road_at, house.station) + 2.6),
        width=0.8,
        height=rng.uniform(0.8, 1.6),
        bright=1.0,
    )


def _plant(models: Models, rng: np.random.Generator, kind: str, station: float, lateral: float, height: float) -> Thing:
    size = {"width": height * rng.uniform(0.75, 1.25), "height": height, "bright": rng.uniform(0.7, 1.2)}
    return Thing(BILLBOARD, int(rng.choice(models[kind])), station, lateral, **size)


def _kerbside_plants(course: Course, models: Models, rng: np.random.Generator, side: float) -> Iterator[Thing]:
    """Trees and bushes along a wide street, a small tree here and there in a narrow one."""
    for at in _stations(course, rng, 6.0, 13.0):
        kerb = _at(course.half_road_at, at)
        if _at(course.narrowness_at, at) > 0.5:
            if rng.random() < 0.15:
                yield _plant(models, rng, "tree", at, side * (kerb + 1.2), 4.0)
        elif rng.random() < 0.7:
            kind = "conifer" if rng.random() < 0.25 else "tree"
            yield _plant(models, rng, kind, at, side * (kerb + rng.uniform(1.0, 4.0)), rng.uniform(5.0, 9.0))
            beside = at + rng.uniform(-4.0, 4.0)
            yield _plant(models, rng, "bush", beside, side * (kerb + rng.uniform(3.0, 6.0)), rng.uniform(1.2, 2.8))


def _posts(course: Course, models: Models, rng: np.random.Generator, side: float) -> Iterator[Thing]:
    """Lamp posts and traffic signs."""
    for at in _stations(course, rng, 10.0, 25.0):
        kind, width, height = ("lamp", 1.6, 6.5) if rng.random() < 0.4 else ("sign", 0.65, 2.6)
        lateral = side * (_at(course.half_road_at, at) + 0.5)
        yield Thing(BILLBOARD, int(rng.choice(models[kind])), at, lateral, width=width, height=height)


def _marks(course: Course, models: Models, rng: np.random.Generator) -> Iterator[Thing]:
    """Patches, cracks and manholes in the road."""
    for at in _stations(course, rng, 2.0, 6.0):
        half = _at(course.half_road_at, at)
        lateral, length, width = rng.uniform(-half, half), rng.uniform(0.6, 3.0), rng.uniform(0.6, 1.4)
        yield Thing(DECAL, int(rng.choice(models["mark"])), at, lateral, length, width)


def _at(profile: Callable[[Float64[np.ndarray, ""]], Float64[np.ndarray, ""]], station: float) -> float:
    """What a profile of the course is at one station."""
    return float(profile(np.array(station)))


def _stations(course: Course, rng: np.random.Generator, least: float, most: float) -> Iterator[float]:
    """Stations all along the street, so many metres apart."""
    at = -BEHIND + rng.uniform(0.0, most)
    while at < course.stations[-1]:
        yield at
        at += rng.uniform(least, most)
