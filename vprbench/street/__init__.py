"""The embedded street world: drawn streets in true perspective, driven twice, without a picture file."""

from __future__ import annotations

from dataclasses import replace
from hashlib import sha256

import numpy as np
import pymap3d

from vprbench.route import Route, Traverse
from vprbench.street.camera import CAMERA
from vprbench.street.course import build_course
from vprbench.street.drive import Drive, plan_drive
from vprbench.street.frames import StreetFrames
from vprbench.street.kitti_tree import draw_kitti, draw_kitti_raw
from vprbench.street.parameters import Environment, StreetParameters

__all__ = ["Environment", "StreetParameters", "draw_kitti", "draw_kitti_raw", "street_route"]

# Part of every checksum: to be counted up whenever the same parameters draw other pictures.
_EDITION = 1
_TRAINING_LENGTH = 100.0
_SEEDS = 2**31  # a training street lies half of all seeds away, where nobody looks for one to evaluate


def street_route(parameters: StreetParameters, *, name: str) -> Route:
    """A drawn street driven twice, and a drive through another street of its kind to train on.

    The difficulty is that of the second drive alone: what was learned once serves a whole robustness curve.
    """
    first = StreetParameters(
        parameters.environment, parameters.length, parameters.seed, learn_step=parameters.learn_step
    )
    elsewhere = replace(first, seed=(parameters.seed + _SEEDS // 2) % _SEEDS, length=_TRAINING_LENGTH)
    return Route(
        name=name,
        learn=_traverse(first, "learn", f"{name}, learn"),
        test=_traverse(parameters, "test", f"{name}, test"),
        training=(_traverse(elsewhere, "learn", f"{name}, training"),),
        environment=parameters.environment,
    )


def _traverse(parameters: StreetParameters, drive: Drive, name: str) -> Traverse:
    course = build_course(parameters.environment, parameters.length, parameters.seed)
    motion = plan_drive(course, parameters, drive)
    east, north = motion.positions.T
    latitude, longitude, _ = pymap3d.enu2geodetic(east, north, 0.0, 0.0, 0.0, 0.0)
    return Traverse(
        name=name,
        frames=StreetFrames(parameters, drive),
        positions=motion.positions,
        headings=motion.headings,
        times=motion.times,
        camera=CAMERA,
        indices=np.arange(len(motion.times)),
        checksum=sha256(f"{_EDITION}, {drive}, {parameters}".encode()).hexdigest(),
        geodetic=np.stack([latitude, longitude], axis=1),
    )
