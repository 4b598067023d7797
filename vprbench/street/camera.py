"""The vehicle's camera: that of KITTI, its pictures reduced to our frames."""

from __future__ import annotations

from vprbench.route import Camera
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH

__all__ = ["CAMERA", "CY", "EYE", "FY"]

# The left grey camera of sequence 00: 1241 x 376, fx = fy = 718.856, cx = 607.193, cy = 185.216.
_WIDTH, _HEIGHT = 1241, 376
CAMERA = Camera(fx=718.856 * FRAME_WIDTH / _WIDTH, cx=607.1928 * FRAME_WIDTH / _WIDTH)
FY, CY = 718.856 * FRAME_HEIGHT / _HEIGHT, 185.2157 * FRAME_HEIGHT / _HEIGHT

# How high it sits above the road, metres.
EYE = 1.65
