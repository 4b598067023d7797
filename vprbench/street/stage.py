"""What one drive sees: the street, and the cars and the sun of that day."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float64

from vprbench.street.course import Course
from vprbench.street.drive import Drive, Motion, lane, plan_drive
from vprbench.street.mesh import CAR
from vprbench.street.parameters import StreetParameters
from vprbench.street.scenery import Scenery, build_scenery, half_width
from vprbench.street.sunlight import Sunlight
from vprbench.street.things import Things, place, stand
from vprbench.street.wardrobe import Wardrobe

__all__ = ["Stage", "set_stage"]

_SLOT = 6.0  # metres of kerb for each parked car
_CLEARANCE = 1.9  # metres from the vehicle's path within which no car is parked


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


@dataclass(frozen=True)
class Stage:
    """Everything that is drawn on one drive.

    Attributes:
        scenery: what stands still on all days.
        motion: the vehicle's poses.
        parked: this day's parked cars, sorted by station.
        traffic: this day's moving cars.
        sunlight: this day's sun.
        sky: number of the sky's texture.
    """

    scenery: Scenery
    motion: Motion
    parked: Things
    traffic: Traffic
    sunlight: Sunlight
    sky: int


@lru_cache(maxsize=8)
def set_stage(parameters: StreetParameters, drive: Drive) -> Stage:
    """The stage of one drive; the same arguments always give the same one."""
    scenery = build_scenery(parameters.environment, parameters.length, parameters.seed)
    motion = plan_drive(scenery.course, parameters, drive)
    second = drive == "test"
    return Stage(
        scenery=scenery,
        motion=motion,
        parked=_parked(scenery, parameters, motion, second),
        traffic=_traffic(scenery, parameters, motion, second),
        sunlight=_sunlight(scenery, parameters, second),
        sky=scenery.wardrobe.models["sky"][second],
    )


def _sunlight(scenery: Scenery, parameters: StreetParameters, second: bool) -> Sunlight:
    rng = np.random.default_rng([parameters.seed, 5])
    turned = np.radians(parameters.sun_shift) if second else 0.0
    azimuth = scenery.course.heading_at(np.zeros(1))[0] + rng.uniform(0.6, 1.2) * rng.choice([-1, 1]) + turned
    elevation = np.radians(rng.uniform(38, 48)) - 0.15 * turned
    return Sunlight.over(scenery.course, scenery.outline, azimuth, elevation, rng.random((64, 64)))


def _parked(scenery: Scenery, parameters: StreetParameters, motion: Motion, second: bool) -> Things:
    """Parked cars; on the second drive a share of the places by the kerb is filled anew."""
    course = scenery.course
    first = _kerbside(scenery, np.random.default_rng([parameters.seed, 6]))
    if second:
        rng = np.random.default_rng([parameters.seed, 7])
        changed = rng.random(len(first)) < parameters.occluders
        anew = _kerbside(scenery, rng)
        first = [new if change else old for old, new, change in zip(first, anew, changed, strict=True)]
    rows = [row for row in first if row]
    if not rows:
        return place(course, rows)
    things = place(course, rows)
    path = np.interp(things["station"], motion.stations, motion.laterals)
    return things[np.abs(things["lateral"] - path) > _CLEARANCE]


def _kerbside(scenery: Scenery, rng: np.random.Generator) -> list[dict[str, float]]:
    """One row for each place by the kerb, empty where no car stands."""
    course, rows = scenery.course, []
    for side in (-1.0, 1.0):
        for station in np.arange(course.stations[0], course.stations[-1], _SLOT):
            narrow = float(course.narrowness_at(np.array(station)))
            row = _car(scenery.wardrobe, rng) | {"station": station + rng.uniform(-0.6, 0.6)}
            row["lateral"] = side * (float(half_width(course, np.array(station))) - rng.uniform(0.8, 1.0))
            row["forward"] = side
            rows.append(row if rng.random() < 0.25 + 0.35 * narrow else {})
    return rows


def _car(wardrobe: Wardrobe, rng: np.random.Generator) -> dict[str, float]:
    van = rng.random() < 0.12
    return {
        "length": rng.uniform(4.6, 5.2) if van else rng.uniform(3.7, 4.6),
        "width": rng.uniform(1.65, 1.85),
        "height": rng.uniform(1.8, 2.1) if van else rng.uniform(1.38, 1.55),
        "mesh": CAR,
        "skin": int(rng.choice(wardrobe.models["car"])),
    }


def _traffic(scenery: Scenery, parameters: StreetParameters, motion: Motion, second: bool) -> Traffic:
    """Moving cars; oncoming ones only where the street is wide enough for two."""
    rng = np.random.default_rng([parameters.seed, 8, second])
    count = rng.poisson(parameters.occluders * parameters.length / 40.0)
    frame = rng.uniform(0, len(motion.times), count)
    met = np.interp(frame, np.arange(len(motion.times)), motion.stations)
    oncoming = (scenery.course.narrowness_at(met) < 0.5) & (rng.random(count) < 0.7)
    forward = np.where(oncoming, -1.0, 1.0)
    rows = [_car(scenery.wardrobe, rng) | {"station": 0.0, "lateral": 0.0, "forward": f} for f in forward]
    return Traffic(
        things=place(scenery.course, rows),
        frame=frame,
        nearest=np.where(oncoming, 0.0, rng.uniform(9.0, 25.0, count)),
        speed=np.where(oncoming, rng.uniform(1.6, 2.6, count), rng.uniform(0.2, 0.8, count)),
    )
