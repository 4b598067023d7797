"""The frames of a drive along a drawn street, each drawn when it is asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64

from vprbench.route import Camera
from vprbench.street.backdrop import paint_ground, paint_sky
from vprbench.street.drive import Drive
from vprbench.street.film import develop
from vprbench.street.mesh import MESHES
from vprbench.street.parameters import StreetParameters
from vprbench.street.raster import Canvas, View, paint_things
from vprbench.street.scenery import half_width
from vprbench.street.stage import Stage, set_stage
from vprbench.street.things import Things
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Frame

__all__ = ["CAMERA", "StreetFrames", "draw", "view_at"]

# KITTI's left grey camera (sequence 00: 1241 x 376, fx = fy = 718.856, cx = 607.193, cy = 185.216),
# reduced to our frames; it sits 1.65 m above the road.
CAMERA = Camera(fx=718.856 * FRAME_WIDTH / 1241, cx=607.1928 * FRAME_WIDTH / 1241)
_FY, _CY, _EYE = 718.856 * FRAME_HEIGHT / 376, 185.2157 * FRAME_HEIGHT / 376, 1.65

# How far one sees along the street, metres.
_SIGHT_BEHIND, _SIGHT_AHEAD = 12.0, 140.0


@dataclass(frozen=True)
class StreetFrames:
    """Frame t of one drive on demand; the same t always gives the same bytes."""

    parameters: StreetParameters
    drive: Drive

    def __getitem__(self, index: int, /) -> Frame:
        """Frame `index`, drawn anew."""
        parameters, second = self.parameters, self.drive == "test"
        stage = set_stage(parameters, self.drive)
        light = draw(stage, index).light
        index = range(len(stage.motion.times))[index]
        return develop(
            light,
            stops=parameters.exposure if second else 0.0,
            noise=parameters.noise if second else min(parameters.noise, 2.0),
            rng=np.random.default_rng([parameters.seed, 9, second, index]),
        )


def view_at(stage: Stage, index: int) -> View:
    """The camera at one frame of a drive."""
    motion = stage.motion
    heading = motion.headings[index]
    return View(
        width=FRAME_WIDTH,
        height=FRAME_HEIGHT,
        fx=CAMERA.fx,
        fy=_FY,
        cx=CAMERA.cx,
        cy=_CY + _FY * float(np.tan(motion.pitches[index])),
        east=motion.positions[index, 0],
        north=motion.positions[index, 1],
        up=_EYE,
        cos=np.cos(heading),
        sin=np.sin(heading),
        station=motion.stations[index],
        lateral=motion.laterals[index],
    )


def draw(stage: Stage, index: int) -> Canvas:
    """The painted canvas of one frame."""
    view, scenery = view_at(stage, index), stage.scenery
    canvas = Canvas.blank(view.height, view.width)
    skins, models = scenery.wardrobe.skins, scenery.wardrobe.models
    groups = [scenery.things, stage.parked, stage.traffic.at(scenery.course, view.station, index)]
    near = np.concatenate([_in_sight(things, view.station) for things in groups])
    paint_things(canvas, view, near, MESHES, skins, stage.sunlight)
    paint_ground(canvas, view, _ground_course(stage), skins, models["ground"][0], stage.sunlight)
    paint_sky(canvas, view, skins, stage.sky, np.arctan2(view.sin, view.cos))
    return canvas


def _in_sight(things: Things, station: float) -> Things:
    at = things["station"]
    return things[(at > station - _SIGHT_BEHIND) & (at < station + _SIGHT_AHEAD)]


def _ground_course(stage: Stage) -> Float64[np.ndarray, "stations 5"]:
    course = stage.scenery.course
    half = half_width(course, course.stations)
    return np.column_stack([course.centre, np.cos(course.heading), np.sin(course.heading), half])
