"""The protocol: learn, record and test phases of one localizer on one route, and the Trace they leave.

A localizer plays the phases frame by frame through `RouteEnv` (`play`). One that offers `describe` and `compare`
gives the same answers from one frame x frame response matrix (`ResponseMatrix`), for every sampling distance at
once; the tests hold the two equal.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.wrappers import FilterObservation
from jaxtyping import Float32, Int64

from vprbench.observation import Drive, senses
from vprbench.protocols import Localizer
from vprbench.recruiting import bisect_vigilance
from vprbench.route import Route
from vprbench.trace import Trace
from vprbench.truth import metric_truth, place_field_truth, ranks
from vprbench.types import NO_PLACE, Hypothesis, Observation, Responses, hypothesis

__all__ = ["Recording", "calibrate", "judge", "play", "winners"]


@dataclass(frozen=True)
class Recording:
    """What a localizer answered in the three phases.

    Attributes:
        place_frames: (places,) the learn frame at which each place was made.
        winners: (frames,) the place that responded most at each learn frame in the record phase, -1 for none.
        responses: (queries, places) response of every place to every test frame.
    """

    place_frames: Int64[np.ndarray, " places"]
    winners: Int64[np.ndarray, " frames"]
    responses: Float32[np.ndarray, "queries places"]


def winners(responses: Float32[np.ndarray, "frames places"]) -> Int64[np.ndarray, " frames"]:
    """The place that responds most in each row, `NO_PLACE` where none does."""
    return np.array([hypothesis(row).place for row in responses], np.int64)


def play(env: gym.Env[Observation, dict[str, Any]], localizer: Localizer) -> Recording:
    """Play all three phases frame by frame; GPS is withheld from record and test.

    The localizer must already be fitted, and cleared to its vigilance or step.
    """
    places: list[int] = []
    answered: list[Responses] = []

    def learn(observation: Observation) -> Hypothesis:
        place = localizer.learn(observation)
        places.append(NO_PLACE if place is None else place)
        return Hypothesis(places[-1], 0.0)

    def respond(observation: Observation) -> Hypothesis:
        answered.append(localizer.respond(observation))
        return hypothesis(answered[-1])

    blind = FilterObservation(env, senses(env.observation_space))
    _drive(env, "learn", learn)
    recorded = _drive(blind, "record", respond)
    answered.clear()
    _drive(blind, "test", respond)
    return Recording(np.flatnonzero(np.array(places) >= 0), recorded, np.stack(answered))


def _drive(
    env: gym.Env[Any, dict[str, Any]], phase: str, answer: Callable[[Observation], Hypothesis]
) -> Int64[np.ndarray, " frames"]:
    """Play one phase; the places answered, frame by frame."""
    observation, _ = env.reset(options={"phase": phase})
    given, ended = [], False
    while not ended:
        place, confidence = answer(observation)
        action = {"place": place, "confidence": np.float32(confidence)}
        observation, _, ended, _, _ = env.step(action)
        given.append(place)
    return np.array(given, np.int64)


def calibrate(localizer: Localizer, route: Route, sampling_distance: float) -> float:
    """The vigilance or step at which a localizer makes a place every `sampling_distance` on average.

    A vigilance is found by bisection, learning the drive anew at each try. The localizer is left cleared to it.
    """

    def count(vigilance: float) -> int:
        localizer.clear(vigilance)
        return sum(localizer.learn(observation) is not None for observation in Drive(route.learn))

    if localizer.recruiting == "step":
        sampling = sampling_distance
    else:
        sampling = bisect_vigilance(count, route.learn.length / sampling_distance)
    localizer.clear(sampling)
    return sampling


def judge(route: Route, recording: Recording, sampling_distance: float) -> Trace:
    """The trace of a recording: every answer of the test beside the truth, by both rules."""
    visit = route.visit
    responses, queries = recording.responses, np.arange(len(route.test))
    best = [hypothesis(row) for row in responses]
    place = np.array([answer.place for answer in best], np.int64)
    made = place != NO_PLACE
    right = place_field_truth(visit, recording.winners, len(recording.place_frames))
    right_metric = metric_truth(visit, recording.place_frames, sampling_distance)
    gaps = visit.gaps[:, recording.place_frames]
    return Trace(
        frame=route.test.indices,
        truth=visit.true_places(recording.winners),
        hypothesis=place,
        confidence=np.array([answer.confidence for answer in best], np.float64),
        error_m=np.where(made, gaps[queries, place], np.nan),
        tolerance_m=visit.tolerance,
        correct=made & right[queries, place],
        correct_metric=made & right_metric[queries, place],
        rank=ranks(responses, right),
        rank_metric=ranks(responses, right_metric),
        east=route.test.positions[:, 0],
        north=route.test.positions[:, 1],
    )
