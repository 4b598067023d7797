"""The route environment: one road driven twice, played as Gymnasium episodes of three phases."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal, get_args

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.error import InvalidAction, ResetNeeded
from jaxtyping import Float32, Int64, UInt8

from vprbench.catalogue import load_route
from vprbench.errors import ConfigError, PhaseError, nearest
from vprbench.observation import observation_space, observe
from vprbench.rendering import Scene, draw
from vprbench.route import Route, Traverse
from vprbench.types import NO_PLACE, Observation

__all__ = ["Phase", "RouteEnv"]

Phase = Literal["learn", "record", "test"]

# Columns u and rows v, pixels.
Points = Float32[np.ndarray, "points 2"]
NO_POINTS: Points = np.empty((0, 2), np.float32)


class RouteEnv(gym.Env[Observation, dict[str, Any]]):
    """One route as a Gymnasium environment; one frame is one step, one drive one episode.

    `reset(options={"phase": ...})` chooses the phase (default "learn"), which gives the action its meaning:

    - learn: `place` is the place recruited at this frame (0, 1, ...), or -1. Starts an empty map.
    - record: the learn drive again; `place` is the place that responds most. Its winners become the place
      fields, which are the truth of the test.
    - test: the second drive; `place` is the hypothesis, -1 for none. The reward is 1 where it is right by the
      place-field rule.

    `info` always holds phase, frame (its number in the data set) and, where the data set has them, latitude and
    longitude; after a step of the test also error_m, correct, correct_metric and true_place.

    Args:
        route: a route, or the name of one in the catalogue.
        sampling_distance: metres (on a route in frames: frames) between places that the metric rule assumes: a
            hypothesis is right by it within half of this plus the query's own tolerance.
        data: the data root (default: VPRBENCH_DATA, else the user's data folder).
        render_mode: "rgb_array" or None.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012 - as Gymnasium declares it

    def __init__(
        self,
        route: Route | str,
        sampling_distance: float = 3.0,
        data: Path | str | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.route = load_route(route, data=data) if isinstance(route, str) else route
        self.sampling_distance = sampling_distance
        self.render_mode = render_mode
        frames = len(self.route.learn)
        self.observation_space = observation_space(self.route)  # type: ignore[assignment]
        self.action_space = spaces.Dict(
            {
                "place": spaces.Discrete(frames + 1, start=NO_PLACE),
                "confidence": spaces.Box(0.0, 1.0, (), np.float32),
            }
        )
        self.place_frames: Int64[np.ndarray, " frames"] = np.full(frames, NO_PLACE)
        self.winners: Int64[np.ndarray, " frames"] = np.full(frames, NO_PLACE)
        self._visit = self.route.visit
        self._phase: Phase = "learn"
        self._played: set[Phase] = set()
        self._index: int | None = None
        self._hypothesis = NO_PLACE
        self._marked: Points = NO_POINTS
        self._shown: tuple[int, Points] = (0, NO_POINTS)

    @property
    def drive(self) -> Traverse:
        """The traverse that this phase plays."""
        return self.route.test if self._phase == "test" else self.route.learn

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin a phase at the first frame of its drive.

        Raises:
            ConfigError: the phase has no such name.
            PhaseError: the phase builds on one that was not played.
        """
        super().reset(seed=seed)
        self._enter(str((options or {}).get("phase", "learn")))
        self._index, self._hypothesis = 0, NO_PLACE
        self._marked, self._shown = NO_POINTS, (0, NO_POINTS)
        return observe(self.drive, 0), self._info(0)

    def step(self, action: dict[str, Any]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Take the agent's answer to the present frame, and move on to the next one."""
        if self._index is None:
            raise ResetNeeded("this episode has ended: call reset(options={'phase': ...}) to begin the next")
        index, place = self._index, self._answered(action)
        info = self._info(index)
        reward = self._judge(index, place, info)
        self._hypothesis = place
        self._marked, self._shown = NO_POINTS, (index, self._marked)
        ended = index + 1 == len(self.drive)
        self._index = None if ended else index + 1
        if ended:
            self._played.add(self._phase)
        return observe(self.drive, index if ended else index + 1), reward, ended, False, info

    def mark(self, points: Points) -> None:
        """Show these focus points of the present frame when its answer is rendered."""
        self._marked = points

    def render(self) -> UInt8[np.ndarray, "height width 3"] | None:
        """The last answered frame with its focus points, the retrieved place's frame, and the map."""
        if self.render_mode is None:
            return None
        scene = Scene(self.route, self.drive, self._phase, *self._shown, self.place_frames, self._hypothesis)
        return draw(scene)

    def _enter(self, phase: str) -> None:
        """Make `phase` the present one, and drop what it will build anew."""
        if phase not in get_args(Phase):
            raise ConfigError(f"no phase {phase!r}: {nearest(phase, get_args(Phase))}")
        needed: Phase | None = {"record": "learn", "test": "record"}.get(phase)  # type: ignore[assignment]
        if needed is not None and needed not in self._played:
            raise PhaseError(f"{self.route.name}: play the {needed} phase to its end before the {phase} phase")
        if phase == "learn":
            self._played.clear()
            self.place_frames[:] = NO_PLACE
        if phase == "record":
            self._played.discard("record")
            self.winners[:] = NO_PLACE
        self._phase = phase  # type: ignore[assignment]

    def _answered(self, action: dict[str, Any]) -> int:
        """The action's place; an action outside the action space is refused."""
        try:
            place, confidence = int(action["place"]), float(action["confidence"])
        except (KeyError, TypeError, ValueError) as error:
            raise InvalidAction(f"an action is {{'place': int, 'confidence': float}}, not {action!r}") from error
        if not NO_PLACE <= place < len(self.place_frames):
            raise InvalidAction(f"place {place} is not in {NO_PLACE}..{len(self.place_frames) - 1}")
        if not 0.0 <= confidence <= 1.0:
            raise InvalidAction(f"confidence {confidence} is not in 0..1")
        return place

    def _judge(self, index: int, place: int, info: dict[str, Any]) -> float:
        """Note the answer as the phase demands; the reward, and in the test the truth added to `info`."""
        if self._phase == "learn":
            if place != NO_PLACE and self.place_frames[place] == NO_PLACE:
                self.place_frames[place] = index
            return 0.0
        if self._phase == "record":
            self.winners[index] = place
            return 0.0
        info.update(self._truth(index, place))
        return float(info["correct"])

    def _truth(self, index: int, place: int) -> dict[str, Any]:
        """What the referee knows about a hypothesis at test frame `index`."""
        made = place != NO_PLACE and self.place_frames[place] != NO_PLACE
        error = float(self._visit.gaps[index, self.place_frames[place]]) if made else float("nan")
        tolerance = float(self._visit.tolerance[index])
        return {
            "error_m": error,
            "tolerance_m": tolerance,
            "correct": bool(made and place in self.winners[self._visit.answers[index]]),
            "correct_metric": bool(error <= self.sampling_distance / 2 + tolerance),
            "true_place": int(self._visit.true_places(self.winners)[index]),
        }

    def _info(self, index: int) -> dict[str, Any]:
        """What is known of the frame beside what is sensed."""
        info: dict[str, Any] = {"phase": self._phase, "frame": int(self.drive.indices[index])}
        if self.drive.geodetic is not None:
            info["latitude"], info["longitude"] = map(float, self.drive.geodetic[index])
        return info
