"""The camera that looks at the street, and the canvas on which it is painted.

A canvas keeps, beside the light that has reached each pixel, how clear the pixel still is: what lies
nearer has taken its share, and what lies behind paints only the rest. So every pixel is filled about once,
and edges and leaves blend with whatever is behind them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32

__all__ = ["OPAQUE", "Canvas", "View"]

# A pixel no clearer than this is full.
OPAQUE = 0.004


class View(NamedTuple):
    """A pinhole camera somewhere in the street: sizes in pixels, place in metres.

    Attributes:
        fx, fy: focal lengths.
        cx, cy: principal point; the vehicle's pitch moves cy.
        east, north, up: where the camera is.
        cos, sin: of its heading, clockwise from north.
        station: how far along the street that is.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    east: float
    north: float
    up: float
    cos: float
    sin: float
    station: float


class Canvas(NamedTuple):
    """A frame being painted: the light so far, and how clear each pixel still is (1..0)."""

    light: Float32[np.ndarray, "height width"]
    clear: Float32[np.ndarray, "height width"]

    @classmethod
    def blank(cls, height: int, width: int) -> Canvas:
        """A canvas on which nothing is painted."""
        return cls(np.zeros((height, width), np.float32), np.ones((height, width), np.float32))
