"""The protocol: playing the environment and reading the response matrix give one and the same trace."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import cv2
import numpy as np
import pytest

from vprbench.env import RouteEnv
from vprbench.episode import calibrate, judge, play
from vprbench.metrics import evaluate
from vprbench.observation import Drive
from vprbench.protocols import DescriptorLocalizer, Recruiting
from vprbench.recruiting import Odometer
from vprbench.response_matrix import ResponseMatrix
from vprbench.route import Route
from vprbench.trace import Trace
from vprbench.types import Observation, Responses


class Thumbnails:
    """A plain localizer: the correlation of small pictures."""

    recruiting: ClassVar[Recruiting] = "vigilance"

    def __init__(self, sampling: float = 0.5) -> None:
        self.clear(sampling)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Nothing to learn."""

    def clear(self, sampling: float) -> None:
        self.sampling = sampling
        self.odometer = Odometer(sampling)
        self.places: list[np.ndarray] = []

    def learn(self, observation: Observation) -> int | None:
        if not self.is_due(observation):
            return None
        self.places.append(self.describe(observation))
        return len(self.places) - 1

    def is_due(self, observation: Observation) -> bool:
        return not self.places or bool(self.respond(observation).max() < np.float32(self.sampling))

    def respond(self, observation: Observation) -> Responses:
        return self.compare([self.describe(observation)], self.places)[0]

    def describe(self, observation: Observation) -> np.ndarray:
        small = cv2.resize(observation["frame"], (32, 8), interpolation=cv2.INTER_AREA).ravel().astype(np.float64)
        small -= small.mean()
        return small / max(float(np.linalg.norm(small)), 1e-9)

    def compare(self, queries: Sequence[np.ndarray], places: Sequence[np.ndarray]) -> np.ndarray:
        rows = [[float(query @ place) for place in places] for query in queries]
        return np.clip(np.array(rows, np.float32).reshape(len(queries), len(places)), 0, 1)


class SteppedThumbnails(Thumbnails):
    """The same, with a place at every step of road."""

    recruiting: ClassVar[Recruiting] = "step"

    def is_due(self, observation: Observation) -> bool:
        return self.odometer.due(observation["gps"])


def equal(a: Trace, b: Trace) -> bool:
    return a.to_frame().equals(b.to_frame())


@pytest.mark.parametrize("kind", [Thumbnails, SteppedThumbnails])
@pytest.mark.parametrize("distance", [2.0, 5.0])
def test_matrix_and_environment_agree_exactly(toy_route: Route, kind: type[Thumbnails], distance: float) -> None:
    localizer = kind()
    matrix: ResponseMatrix[np.ndarray] = ResponseMatrix(toy_route, localizer)
    sampling = matrix.sampling(distance)
    assert calibrate(localizer, toy_route, distance) == sampling
    played = play(RouteEnv(toy_route, distance), localizer)
    read = matrix.recording(sampling)
    assert np.array_equal(played.place_frames, read.place_frames)
    assert np.array_equal(played.winners, read.winners)
    assert np.array_equal(played.responses, read.responses)
    assert equal(judge(toy_route, played, distance), judge(toy_route, read, distance))


@pytest.mark.parametrize("kind", [Thumbnails, SteppedThumbnails])
def test_places_lie_a_sampling_distance_apart_on_average(toy_route: Route, kind: type[Thumbnails]) -> None:
    matrix: ResponseMatrix[np.ndarray] = ResponseMatrix(toy_route, kind())
    for distance in (2.0, 4.0):
        places = len(matrix.recording(matrix.sampling(distance)).place_frames)
        assert toy_route.learn.length / places == pytest.approx(distance, rel=0.2)


def test_the_environment_rewards_what_the_trace_calls_correct(toy_route: Route) -> None:
    localizer = SteppedThumbnails(3.0)
    env = RouteEnv(toy_route, 3.0)
    trace = judge(toy_route, play(env, localizer), 3.0)
    observation, _ = env.reset(options={"phase": "test"})
    for expected in trace.to_frame().itertuples():
        responses = localizer.respond(observation)
        action = {"place": int(responses.argmax()), "confidence": responses.max()}
        observation, reward, _, _, info = env.step(action)
        assert reward == expected.correct
        assert info["correct_metric"] == expected.correct_metric
        assert info["error_m"] == expected.error_m
        assert info["true_place"] == expected.truth
    assert 0 < trace.correct.mean() <= 1


def test_gps_is_withheld_from_record_and_test(toy_route: Route) -> None:
    seen: list[bool] = []

    class Spy(SteppedThumbnails):
        def learn(self, observation: Observation) -> int | None:
            assert "gps" in observation
            return super().learn(observation)

        def respond(self, observation: Observation) -> Responses:
            seen.append("gps" in observation)
            return super().respond(observation)

    play(RouteEnv(toy_route), Spy(3.0))
    assert len(seen) == len(toy_route.learn) + len(toy_route.test)
    assert not any(seen)


def test_toy_localizers_keep_the_protocol() -> None:
    assert isinstance(Thumbnails(), DescriptorLocalizer)


class Rigged(SteppedThumbnails):
    """Answers from a side door: `answers` gives the responses to query t of the test."""

    def __init__(self, answers: np.ndarray) -> None:
        super().__init__(1.0)
        self.answers, self.asked = answers, 0

    def respond(self, observation: Observation) -> Responses:
        """In the record phase every place wins at its own frame; then come the rigged answers."""
        frames = len(self.places)
        row = np.eye(frames, dtype=np.float32)[self.asked] if self.asked < frames else self.answers[self.asked - frames]
        self.asked += 1
        return row


def score(route: Route, answers: np.ndarray) -> dict[str, float]:
    """Scores of a localizer that learns every frame and gives these answers."""
    recording = play(RouteEnv(route), Rigged(answers.astype(np.float32)))
    assert len(recording.place_frames) == len(route.learn)
    return evaluate(judge(route, recording, 1.0))


def one_hot(places: np.ndarray, frames: int) -> np.ndarray:
    return np.eye(frames, dtype=np.float32)[places]


def test_a_cheat_scores_one(toy_route: Route) -> None:
    learn, test = toy_route.learn.positions, toy_route.test.positions
    nearest = np.linalg.norm(test[:, None] - learn[None], axis=2).argmin(axis=1)
    scores = score(toy_route, one_hot(nearest, len(learn)))
    for name in ("auc", "auc_all", "accuracy", "recall_at_1", "recall_at_100_precision", "accuracy_metric"):
        assert scores[name] == 1.0, name


def test_always_place_zero_scores_its_share(toy_route: Route) -> None:
    scores = score(toy_route, one_hot(np.zeros(30, int), 41))
    # Only the first query (0.3 m on, nearest to frame 0) is answered rightly.
    assert scores["accuracy"] == pytest.approx(1 / 30)
    assert scores["auc_all"] == pytest.approx(scores["auc"] * scores["accuracy"])


def test_random_answers_score_what_chance_predicts(toy_route: Route) -> None:
    rng = np.random.default_rng(0)
    scores = [score(toy_route, one_hot(rng.integers(0, 41, 30), 41))["accuracy"] for _ in range(60)]
    # One place of 41 is right for a query: 1800 draws, standard error 0.0037.
    assert np.mean(scores) == pytest.approx(1 / 41, abs=3 * 0.0037)


def test_silence_is_no_match(toy_route: Route) -> None:
    for silence in (np.zeros((30, 41)), np.full((30, 41), np.nan)):
        scores = score(toy_route, silence)
        assert scores["no_match"] == 1.0
        assert scores["accuracy"] == scores["auc"] == scores["recall_at_20"] == 0.0


def test_the_description_of_a_frame_is_computed_once(toy_route: Route) -> None:
    counted = 0

    class Counting(Thumbnails):
        def describe(self, observation: Observation) -> np.ndarray:
            nonlocal counted
            counted += 1
            return super().describe(observation)

    matrix: ResponseMatrix[np.ndarray] = ResponseMatrix(toy_route, Counting())
    for distance in (2.0, 3.0, 5.0):
        matrix.recording(matrix.sampling(distance))
    assert counted == len(Drive(toy_route.learn)) + len(Drive(toy_route.test))
