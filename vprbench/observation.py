"""What is sensed at one frame, and the Gymnasium space it lies in, side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, overload

import numpy as np
from gymnasium import spaces

from vprbench.route import Route, Traverse
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Observation

__all__ = ["Drive", "observation_space", "observe", "senses"]


def observe(traverse: Traverse, index: int, *, gps: bool = True) -> Observation:
    """The observation at frame `index`; every array in it is the caller's own copy."""
    observation = Observation(
        frame=traverse.frames[index],
        camera=np.array([traverse.camera.fx, traverse.camera.cx], np.float64),
    )
    if traverse.heading_source != "absent":
        observation["heading"] = traverse.headings[index : index + 1].astype(np.float64)
    if gps:
        observation["gps"] = traverse.positions[index].astype(np.float64)
    return observation


def observation_space(route: Route) -> spaces.Dict:
    """The finite space of every observation of both drives of a route; without headings it has none either."""
    positions = np.concatenate([route.learn.positions, route.test.positions])
    sensed: dict[str, spaces.Space[Any]] = {
        "frame": spaces.Box(0, 255, (FRAME_HEIGHT, FRAME_WIDTH), np.uint8),
        "heading": spaces.Box(-np.pi, np.pi, (1,), np.float64),
        "camera": spaces.Box(1.0, 1e5, (2,), np.float64),
        # A metre of margin keeps low below high on a perfectly straight road.
        "gps": spaces.Box(positions.min(axis=0) - 1.0, positions.max(axis=0) + 1.0, dtype=np.float64),
    }
    if route.learn.heading_source == "absent":
        del sensed["heading"]
    return spaces.Dict(sensed)


def senses(space: spaces.Space[Any]) -> list[str]:
    """What is sensed in every phase, by its key in an observation space: all but `gps`."""
    assert isinstance(space, spaces.Dict)
    return [key for key in space if key != "gps"]


class Drive(Sequence[Observation]):
    """A traverse seen as a sequence of observations, each made when it is asked for."""

    def __init__(self, traverse: Traverse, *, gps: bool = True) -> None:
        self.traverse = traverse
        self.gps = gps

    def __len__(self) -> int:
        return len(self.traverse)

    @overload
    def __getitem__(self, index: int) -> Observation: ...
    @overload
    def __getitem__(self, index: slice) -> list[Observation]: ...
    def __getitem__(self, index: int | slice) -> Observation | list[Observation]:
        """Observation at a frame, or at each frame of a slice."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        return observe(self.traverse, range(len(self))[index], gps=self.gps)
