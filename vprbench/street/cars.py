"""The cars of one day: parked along the kerb, and moving."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64

from vprbench.street.course import Course
from vprbench.street.drive import Motion, lane
from vprbench.street.mesh import CAR
from vprbench.street.parameters import StreetParameters
from vprbench.street.scenery import Scenery
from vprbench.street.things import Thing, Things, place, stand
from vprbench.street.wardrobe import Wardrobe

__all__ = ["Traffic", "park_cars", "plan_traffic"]

_SLOT = 6.0  # metres of kerb for each parked car
_CLEARANCE = 1.9  # metres from the vehicle's path within which no car is parked
_METRES_A_CAR = 40.0  # of road for each moving car, where `occluders` is 1


@dataclass(frozen=True)
class Traffic:
    """Moving cars: some come towards the vehicle, some drive ahead of it for a while.

    Attributes:
        things: the cars; only their place changes.
        frame: (n,) at which each is met, or is nearest ahead.
        nearest: (n,) distance kept ahead, metres; 0 for those that are met.
        speed: (n,) at which the distance shrinks and grows again, metres a frame.
    """

    things: Things
    frame: Float64[np.ndarray, " n"]
    nearest: Float64[np.ndarray, " n"]
    speed: Float64[np.ndarray, " n"]

    def at(self, course: Course, station: float, frame: int) -> Things:
        """The cars while the vehicle is at one frame and station."""
        things, gap = self.things.copy(), self.speed * (frame - self.frame)
        things["station"] = station + np.where(self.nearest > 0, self.nearest + np.abs(gap), -gap)
        things["lateral"] = things["forward"] * lane(course, things["station"])
        stand(course, things)
        return things


def park_cars(scenery: Scenery, parameters: StreetParameters, motion: Motion, *, second: bool) -> Things:
    """Parked cars; on the second drive a share of the places by the kerb is filled anew."""
    cars = _kerbside(scenery, np.random.default_rng([parameters.seed, 6]))
    if second:
        rng = np.random.default_rng([parameters.seed, 7])
        changed = rng.random(len(cars)) < parameters.occluders
        cars = [new if change else old for old, new, change in zip(cars, _kerbside(scenery, rng), changed, strict=True)]
    things = place(scenery.course, [car for car in cars if car])
    path = np.interp(things["station"], motion.stations, motion.laterals)
    return things[np.abs(things["lateral"] - path) > _CLEARANCE]


def _kerbside(scenery: Scenery, rng: np.random.Generator) -> list[Thing | None]:
    """The car at each place by the kerb, if one stands there."""
    course = scenery.course
    cars: list[Thing | None] = []
    for side in (-1.0, 1.0):
        for station in np.arange(course.stations[0], course.stations[-1], _SLOT):
            lateral = side * (float(course.half_road_at(station)) - rng.uniform(0.8, 1.0))
            car = _car(scenery.wardrobe, rng, station + rng.uniform(-0.6, 0.6), lateral, side)
            taken = rng.random() < 0.25 + 0.35 * float(course.narrowness_at(station))
            cars.append(car if taken else None)
    return cars


def _car(wardrobe: Wardrobe, rng: np.random.Generator, station: float, lateral: float, forward: float) -> Thing:
    van = rng.random() < 0.12
    return Thing(
        mesh=CAR,
        skin=int(rng.choice(wardrobe.models["car"])),
        station=station,
        lateral=lateral,
        length=rng.uniform(4.6, 5.2) if van else rng.uniform(3.7, 4.6),
        width=rng.uniform(1.65, 1.85),
        height=rng.uniform(1.8, 2.1) if van else rng.uniform(1.38, 1.55),
        forward=forward,
    )


def plan_traffic(scenery: Scenery, parameters: StreetParameters, motion: Motion, *, second: bool) -> Traffic:
    """Moving cars; oncoming ones only where the street is wide enough for two."""
    rng = np.random.default_rng([parameters.seed, 8, second])
    count = rng.poisson(parameters.occluders * parameters.length / _METRES_A_CAR)
    frame = rng.uniform(0, len(motion.times), count)
    met = np.interp(frame, np.arange(len(motion.times)), motion.stations)
    oncoming = (scenery.course.narrowness_at(met) < 0.5) & (rng.random(count) < 0.7)
    cars = [_car(scenery.wardrobe, rng, 0.0, 0.0, forward) for forward in np.where(oncoming, -1.0, 1.0)]
    return Traffic(
        things=place(scenery.course, cars),
        frame=frame,
        nearest=np.where(oncoming, 0.0, rng.uniform(9.0, 25.0, count)),
        speed=np.where(oncoming, rng.uniform(1.6, 2.6, count), rng.uniform(0.2, 0.8, count)),
    )
