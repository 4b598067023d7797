"""How a road lies in a map: turned so that its longest side lies across, in a window that holds all of it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from vprbench.figures.style import WIDTH

__all__ = ["Positions", "Projection", "Window", "left", "projection", "window_on"]

Positions = Float64[np.ndarray, "n 2"]

# Inches: bounds on the height of a window, and from one lane beside the road to the next; the room around a road, as a
# factor; and the frames, before and after, between which a road has its direction.
LOWEST, HIGHEST, LANE, MARGIN, AROUND = 0.4, 2.6, 0.053, 1.08, 5


class Projection(NamedTuple):
    """Turns a road so that its longest side lies across: metres east and north to metres across and up."""

    origin: Float64[np.ndarray, "2"]
    rotation: Float64[np.ndarray, "2 2"]

    def __call__(self, positions: Positions) -> Positions:
        """Where positions, metres east and north, lie in the map."""
        return (positions - self.origin) @ self.rotation


class Window(NamedTuple):
    """What every panel shows: corners in metres, its height in inches, and the metres between two lanes."""

    low: Float64[np.ndarray, "2"]
    high: Float64[np.ndarray, "2"]
    inches: float
    lane: float


def projection(road: Positions) -> Projection:
    """The turn for a road; by less than a quarter, so that a map is never upside down."""
    across = np.linalg.eigh(np.cov(road.T))[1][:, -1] if len(road) > 1 else np.array([1.0, 0.0])
    if across[0] < 0 or (across[0] == 0 and across[1] > 0):
        across = -across
    rotation = np.array([[across[0], -across[1]], [across[1], across[0]]])
    return Projection(np.linalg.solve(rotation.T, (road @ rotation).min(axis=0)), rotation)


def window_on(road: Positions, across: int) -> Window:
    """The window on a road, where so many panels share the width."""
    low, high = road.min(axis=0), road.max(axis=0)
    middle, extent = (low + high) / 2, np.maximum(high - low, 1.0) * MARGIN
    width = WIDTH / across - 0.2
    height = float(np.clip(width * extent[1] / extent[0], LOWEST, HIGHEST))
    scale = max(extent[0] / width, extent[1] / height)
    half = np.array([extent[0], max(extent[1], scale * LOWEST)]) / 2
    return Window(middle - half, middle + half, height, scale * LANE)


def left(road: Positions) -> Positions:
    """(n, 2) unit vectors to the left of a road; nothing where it does not move."""
    frames = np.arange(len(road))
    ahead = road[np.minimum(frames + AROUND, len(road) - 1)] - road[np.maximum(frames - AROUND, 0)]
    length = np.linalg.norm(ahead, axis=1, keepdims=True)
    return np.column_stack([-ahead[:, 1], ahead[:, 0]]) / np.where(length > 0, length, 1.0)
