"""What one drive sees: the street, and the cars and the sun of that day."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from vprbench.street.cars import Traffic, park_cars, plan_traffic
from vprbench.street.drive import Drive, Motion, plan_drive
from vprbench.street.parameters import StreetParameters
from vprbench.street.scenery import Scenery, build_scenery
from vprbench.street.sunlight import Sunlight, sun_over
from vprbench.street.things import Things

__all__ = ["Stage", "set_stage"]


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


@lru_cache(maxsize=6)
def set_stage(parameters: StreetParameters, drive: Drive) -> Stage:
    """The stage of one drive; the same arguments always give the same one."""
    scenery = build_scenery(parameters.environment, parameters.length, parameters.seed)
    motion = plan_drive(scenery.course, parameters, drive)
    second = drive == "test"
    return Stage(
        scenery=scenery,
        motion=motion,
        parked=park_cars(scenery, parameters, motion, second=second),
        traffic=plan_traffic(scenery, parameters, motion, second=second),
        sunlight=_sunlight(scenery, parameters, second),
        sky=scenery.wardrobe.models["sky"][second],
    )


def _sunlight(scenery: Scenery, parameters: StreetParameters, second: bool) -> Sunlight:
    rng = np.random.default_rng([parameters.seed, 5])
    turned = np.radians(parameters.sun_shift) if second else 0.0
    azimuth = scenery.course.heading_at(np.zeros(1))[0] + rng.uniform(0.6, 1.2) * rng.choice([-1, 1]) + turned
    elevation = np.radians(rng.uniform(38, 48)) - 0.15 * turned
    return sun_over(scenery.course, scenery.outline, azimuth, elevation, rng.random((64, 64)))
