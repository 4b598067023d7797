"""Frames and drives to try a plug-in on: textured at every scale, seeded, without any data set."""

from __future__ import annotations

from functools import lru_cache
from math import pi

import cv2
import numpy as np

from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Frame, Observation

__all__ = ["drive", "flat_frame", "textured_frame", "training_drives", "training_frames"]

# Rows and columns of the noise whose enlargements make a texture, coarse to fine.
SCALES = ((4, 14), (12, 40), (47, 160), (FRAME_HEIGHT, FRAME_WIDTH))

# Focal length and principal column of a KITTI camera at 642 x 188, px.
CAMERA = (370.0, 314.0)


def textured_frame(seed: int) -> Frame:
    """Noise of four scales that fills the range of grey; a new array at every call."""
    return _texture(seed).copy()


@lru_cache(maxsize=32)
def _texture(seed: int) -> Frame:
    random = np.random.default_rng(seed)
    layers = [cv2.resize(random.random(scale), (FRAME_WIDTH, FRAME_HEIGHT)) for scale in SCALES]
    picture = np.sum(layers, axis=0)
    picture -= picture.min()
    return np.asarray(255 * picture / picture.max(), np.uint8)


def flat_frame(grey: int) -> Frame:
    """A frame of one grey, 0..255: fog, night, a lens cap."""
    return np.full((FRAME_HEIGHT, FRAME_WIDTH), grey, np.uint8)


def drive(frames: int, first_seed: int = 100, spacing: float = 1.0, *, bent: bool = False) -> list[Observation]:
    """Observations `spacing` metres of road apart, each with a view of its own.

    The road runs straight to the east; a bent one turns at every frame, to the north and to the east again.
    """
    return [
        Observation(
            frame=textured_frame(first_seed + index),
            heading=np.array([0.0 if bent and index % 2 else pi / 2], np.float64),
            camera=np.array(CAMERA, np.float64),
            gps=spacing * np.array([index - index // 2, index // 2] if bent else [index, 0], np.float64),
        )
        for index in range(frames)
    ]


def training_drives() -> list[list[Observation]]:
    """Two short drives whose frames show places well apart, and none of `drive`'s."""
    return [drive(4, first_seed, spacing=30.0) for first_seed in (200, 300)]


def training_frames() -> list[Frame]:
    """The frames of the training drives."""
    return [observation["frame"] for observations in training_drives() for observation in observations]
