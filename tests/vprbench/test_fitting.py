"""How the referee fits: every training frame, step by step, on one thread."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import cv2
import numpy as np
import pytest
from jaxtyping import Float32
from threadpoolctl import threadpool_info

from vprbench.fitting import TrainingFrames, fit
from vprbench.types import Frame, Landmarks, LearningStep, Observation

Matrix = Float32[np.ndarray, "rows columns"]


class Plain:
    """An encoder that remembers what it was fitted on, and on how many threads."""

    def __init__(self) -> None:
        self.fitted: list[int] = []
        self.threads: set[int] = set()

    def fit(self, frames: Sequence[Frame]) -> None:
        self.fitted = [int(frame[0, 0]) for frame in frames]
        self.threads = {cv2.getNumThreads(), *(pool["num_threads"] for pool in threadpool_info())}

    def encode(self, frame: Frame) -> Landmarks:
        raise NotImplementedError

    def match(self, queries: Matrix, memory: Matrix) -> Matrix:
        raise NotImplementedError


class Steps(Plain):
    """One that learns a frame at a step."""

    def learning(self, frames: Sequence[Frame]) -> Iterator[LearningStep]:
        for number in range(len(frames)):
            self.fitted.append(int(frames[number][0, 0]))
            yield LearningStep("S1", number + 1, len(frames), "rate 0.5" if number else "")

    def fit(self, frames: Sequence[Frame]) -> None:
        raise AssertionError("it learns step by step")


def drive(*levels: int) -> list[Observation]:
    camera = np.array([372.0, 314.0])
    return [Observation(frame=np.full((2, 2), level, np.uint8), heading=np.zeros(1), camera=camera) for level in levels]


def test_the_frames_of_all_drives_are_one_sequence() -> None:
    frames = TrainingFrames([drive(10, 20), [], drive(50, 60, 70)])
    assert [int(frame[0, 0]) for frame in frames] == [10, 20, 50, 60, 70]
    assert [int(frame[0, 0]) for frame in frames[1::2]] == [20, 60]
    assert int(frames[-1][0, 0]) == 70
    assert int(frames[-5][0, 0]) == 10
    for beyond in (5, -6):
        with pytest.raises(IndexError):
            frames[beyond]
    assert len(TrainingFrames([])) == 0


def test_an_encoder_is_fitted_on_one_thread_and_the_others_come_back() -> None:
    def threads() -> list[int]:
        return [cv2.getNumThreads(), *(pool["num_threads"] for pool in threadpool_info())]

    before, encoder = threads(), Plain()
    fit(encoder, TrainingFrames([drive(1, 2), drive(3)]))
    assert (encoder.fitted, encoder.threads) == ([1, 2, 3], {1})
    assert threads() == before


def test_every_step_is_reported_with_what_it_says() -> None:
    said: list[tuple[str, int, int, str]] = []
    encoder = Steps()
    fit(encoder, TrainingFrames([drive(1, 2)]), lambda *step: said.append((*step, "")[:4]))
    assert encoder.fitted == [1, 2]
    assert said == [("fit", 0, 1, ""), ("fit", 1, 2, "S1 1/2"), ("fit", 2, 2, "S1 2/2, rate 0.5")]
