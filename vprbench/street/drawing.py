"""A frame drawn: the camera at its pose, and all that it sees from there."""

from __future__ import annotations

import numpy as np

from vprbench.street.camera import CAMERA, CY, EYE, FY
from vprbench.street.canvas import Canvas, View
from vprbench.street.drive import Drive, Motion
from vprbench.street.film import develop
from vprbench.street.ground import paint_ground
from vprbench.street.mesh import MESHES
from vprbench.street.parameters import StreetParameters
from vprbench.street.raster import nearest_first, paint_things
from vprbench.street.sky import paint_sky
from vprbench.street.stage import Stage, set_stage
from vprbench.street.things import Things
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Frame

__all__ = ["draw_frame", "paint", "view_at"]

# How far one sees along the street, metres.
_SIGHT_BEHIND, _SIGHT_AHEAD = 12.0, 140.0
# Standard deviation of the sensor noise of the first drive, grey levels.
_FIRST_NOISE = 2.0


def draw_frame(parameters: StreetParameters, drive: Drive, index: int) -> Frame:
    """Frame `index` of a drive; the same arguments always give the same bytes."""
    stage, second = set_stage(parameters, drive), drive == "test"
    index = range(len(stage.motion.times))[index]
    return develop(
        paint(stage, index).light,
        stops=parameters.exposure if second else 0.0,
        noise=parameters.noise if second else _FIRST_NOISE,
        rng=np.random.default_rng([parameters.seed, 9, second, index]),
    )


def paint(stage: Stage, index: int) -> Canvas:
    """The painted canvas of one frame."""
    view, scenery = view_at(stage.motion, index), stage.scenery
    canvas = Canvas.blank(view.height, view.width)
    skins, models = scenery.wardrobe.skins, scenery.wardrobe.models
    groups = (scenery.things, stage.parked, stage.traffic.at(scenery.course, view.station, index))
    things = np.concatenate([_in_sight(group, view.station) for group in groups])
    paint_things(canvas, view, nearest_first(view, things), MESHES, skins, stage.sunlight)
    paint_ground(canvas, view, scenery.ground, skins.texels, skins.table[models["ground"][0]], stage.sunlight)
    paint_sky(canvas, view, skins.texels, skins.table[stage.sky])
    return canvas


def view_at(motion: Motion, index: int) -> View:
    """The camera at one frame of a drive."""
    heading = motion.headings[index]
    return View(
        width=FRAME_WIDTH,
        height=FRAME_HEIGHT,
        fx=CAMERA.fx,
        fy=FY,
        cx=CAMERA.cx,
        cy=CY + FY * float(np.tan(motion.pitches[index])),
        east=motion.positions[index, 0],
        north=motion.positions[index, 1],
        up=EYE,
        cos=np.cos(heading),
        sin=np.sin(heading),
        station=motion.stations[index],
    )


def _in_sight(things: Things, station: float) -> Things:
    at = things["station"]
    return things[(at > station - _SIGHT_BEHIND) & (at < station + _SIGHT_AHEAD)]
