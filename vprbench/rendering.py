"""The picture of an episode: the frame, the place it was recognised as, and the map, drawn with OpenCV."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float32, Float64, Int32, Int64, UInt8

from vprbench.route import Route, Traverse
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, NO_PLACE

__all__ = ["Scene", "draw"]

Picture = UInt8[np.ndarray, "height width 3"]

MAP_MARGIN = 14
INK, PAPER = (40, 40, 40), 250
LEARN, TEST, HERE, RETRIEVED, FOCUS = (
    (150, 150, 150),
    (60, 110, 220),
    (220, 60, 40),
    (40, 150, 60),
    (255, 190, 40),
)


@dataclass(frozen=True)
class Scene:
    """All that a picture shows of one moment.

    Attributes:
        route: the road.
        drive: the traverse that is being driven.
        phase: learn, record or test.
        index: the present frame of the drive.
        points: (points, 2) focus points of the present frame, pixels; may be empty.
        place_frames: the learn frame at which each place was made, -1 for places not made.
        retrieved: the last answered place, -1 for none.
    """

    route: Route
    drive: Traverse
    phase: str
    index: int
    points: Float32[np.ndarray, "points 2"]
    place_frames: Int64[np.ndarray, " places"]
    retrieved: int


def draw(scene: Scene) -> Picture:
    """RGB picture (564, 642, 3): present frame above retrieved frame above map."""
    title = f"{scene.route.name}  {scene.phase}  frame {scene.drive.indices[scene.index]}"
    return np.vstack([_labelled(_present(scene), title), _retrieved(scene), _map(scene)])


def _present(scene: Scene) -> Picture:
    """The frame the agent sees, with a ring at each focus point."""
    picture = cv2.cvtColor(scene.drive.frames[scene.index], cv2.COLOR_GRAY2RGB)
    for u, v in scene.points.round().astype(int):
        cv2.circle(picture, (int(u), int(v)), 6, FOCUS, 1, cv2.LINE_AA)
    return np.asarray(picture, np.uint8)


def _retrieved(scene: Scene) -> Picture:
    """The learn frame of the answered place, or an empty sheet."""
    made = _frame_of(scene)
    if made == NO_PLACE:
        blank = np.full((FRAME_HEIGHT, FRAME_WIDTH, 3), PAPER, np.uint8)
        return _labelled(blank, "no place answered", INK)
    picture = cv2.cvtColor(scene.route.learn.frames[made], cv2.COLOR_GRAY2RGB)
    return _labelled(np.asarray(picture, np.uint8), f"place {scene.retrieved}")


def _frame_of(scene: Scene) -> int:
    """The learn frame of the answered place, `NO_PLACE` if there is none."""
    return int(scene.place_frames[scene.retrieved]) if scene.retrieved != NO_PLACE else NO_PLACE


def _map(scene: Scene) -> Picture:
    """Both drives from above, north up, with the places, the vehicle and the retrieved place."""
    picture = np.full((FRAME_HEIGHT, FRAME_WIDTH, 3), PAPER, np.uint8)
    learn, test = scene.route.learn.positions, scene.route.test.positions
    pixels = _Projector(np.concatenate([learn, test]))
    for path, colour in ((learn, LEARN), (test, TEST)):
        cv2.polylines(picture, [pixels(path)], False, colour, 1, cv2.LINE_AA)
    for point in pixels(learn[scene.place_frames[scene.place_frames != NO_PLACE]]):
        cv2.circle(picture, point.tolist(), 2, LEARN, -1, cv2.LINE_AA)
    if _frame_of(scene) != NO_PLACE:
        cv2.circle(picture, pixels(learn[[_frame_of(scene)]])[0].tolist(), 6, RETRIEVED, 2, cv2.LINE_AA)
    cv2.circle(picture, pixels(scene.drive.positions[[scene.index]])[0].tolist(), 4, HERE, -1, cv2.LINE_AA)
    return picture


class _Projector:
    """Maps metres to pixels so that given positions fill the map with one scale on both axes."""

    def __init__(self, positions: Float64[np.ndarray, "n 2"]) -> None:
        low, high = positions.min(axis=0), positions.max(axis=0)
        room = np.array([FRAME_WIDTH, FRAME_HEIGHT]) - 2 * MAP_MARGIN
        self.scale = float((room / np.maximum(high - low, 1.0)).min())
        self.middle = (low + high) / 2

    def __call__(self, positions: Float64[np.ndarray, "n 2"]) -> Int32[np.ndarray, "n 2"]:
        east_north = (positions - self.middle) * self.scale
        corner = np.array([FRAME_WIDTH / 2, FRAME_HEIGHT / 2])
        return (corner + east_north * [1.0, -1.0]).round().astype(np.int32)


def _labelled(picture: Picture, text: str, colour: tuple[int, int, int] = (255, 255, 255)) -> Picture:
    """The picture with a line of text in its corner, outlined so that it reads on any ground."""
    for ink, width in (((0, 0, 0), 3), (colour, 1)) if colour != INK else ((INK, 1),):
        cv2.putText(picture, text, (8, 18), cv2.FONT_HERSHEY_SIMPLEX, 0.5, ink, width, cv2.LINE_AA)
    return picture
