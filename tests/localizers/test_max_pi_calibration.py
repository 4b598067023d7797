from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from jaxtyping import Float32

from vprbench.errors import DataError
from vprbench.types import Frame, Landmarks, Observation
from vprbench_localizers.calibration import Calibration
from vprbench_localizers.max_pi import MaxPi

Matrix = Float32[np.ndarray, "rows columns"]


class Brightness:
    """An encoder of one landmark a frame, its signature the frame's brightness in per cent; black has none."""

    def __init__(self) -> None:
        self.encoded: list[int] = []

    def fit(self, frames: Sequence[Frame]) -> None:
        raise AssertionError("the encoder is fitted by others")

    def encode(self, frame: Frame) -> Landmarks:
        level = int(frame[0, 0])
        self.encoded.append(level)
        signatures = np.array([[level / 100]] if level else np.empty((0, 1)), np.float32)
        return Landmarks(signatures, np.ones((len(signatures), 2), np.float32))

    def match(self, queries: Matrix, memory: Matrix) -> Matrix:
        return 1 - np.abs(queries - memory.T)


def drive(*frames: tuple[int, float]) -> list[Observation]:
    """A drive north of frames (brightness, metres)."""
    return [
        Observation(
            frame=np.full((2, 2), level, np.uint8),
            heading=np.zeros(1),
            camera=np.array([372.0, 314.0]),
            gps=np.array([0.0, metres]),
        )
        for level, metres in frames
    ]


def test_the_threshold_is_the_percentile_of_matches_between_different_places() -> None:
    # Further apart than 25 m: only 10-60 (match 0.5), 10-90 (0.2) and 40-90 (0.5), not 10-40 (0.7) or 60-90 (0.7).
    frames = drive((10, 0.0), (40, 20.0), (60, 30.0), (90, 50.0))
    for percentile, expected in (0, 0.2), (50, 0.5), (25, 0.35), (100, 0.5):
        assert Calibration(percentile).threshold(Brightness(), [frames]) == pytest.approx(expected, abs=1e-6)


def test_exactly_the_distance_apart_is_the_same_place() -> None:
    frames = drive((10, 0.0), (20, 25.0), (60, 25.1))
    assert Calibration(100).threshold(Brightness(), [frames]) == pytest.approx(0.5, abs=1e-6)


def test_frames_of_different_drives_are_different_places_wherever_they_lie() -> None:
    drives = [drive((10, 0.0), (20, 1.0)), drive((50, 0.0))]
    assert Calibration(100).threshold(Brightness(), drives) == pytest.approx(0.7, abs=1e-6)


def test_frames_without_landmarks_do_not_count() -> None:
    frames = drive((10, 0.0), (0, 50.0), (60, 100.0), (0, 150.0))
    assert Calibration(0).threshold(Brightness(), [frames]) == pytest.approx(0.5, abs=1e-6)


def test_a_bounded_number_of_frames_is_compared_evenly_over_all_drives() -> None:
    encoder = Brightness()
    drives = [drive(*((level, level * 30.0) for level in range(start, start + 10))) for start in (1, 11)]
    Calibration(frames=5).threshold(encoder, drives)
    assert encoder.encoded == [1, 6, 11, 15, 20]


def test_fit_calibrates_and_forgets_places() -> None:
    agent = MaxPi(Brightness())
    drives = [drive((10, 0.0), (20, 10.0)), drive((50, 0.0))]
    agent.fit(drives)
    assert agent.recognition_threshold == pytest.approx(0.6 + 0.9 * 0.1, abs=1e-6)
    assert agent.learn(drives[0][0]) == 0
    agent.fit(drives[::-1])
    assert agent.respond(drives[0][0]).shape == (0,)


def test_a_threshold_that_is_given_stays() -> None:
    agent = MaxPi(Brightness(), recognition_threshold=0.25)
    agent.fit([drive((10, 0.0))])
    assert agent.recognition_threshold == 0.25


@pytest.mark.parametrize("drives", [[], [[]], [drive((10, 0.0))], [drive((10, 0.0), (20, 5.0))]])
def test_training_that_shows_one_place_is_refused(drives: list[list[Observation]]) -> None:
    with pytest.raises(DataError, match="no two places more than 25 m apart"):
        MaxPi(Brightness()).fit(drives)


def test_training_places_that_all_look_the_same_are_refused() -> None:
    with pytest.raises(DataError, match="Brightness matches different training places with 1"):
        MaxPi(Brightness()).fit([drive((10, 0.0), (10, 50.0))])


def test_training_without_gps_is_refused() -> None:
    frames = drive((10, 0.0), (20, 50.0))
    del frames[1]["gps"]
    with pytest.raises(DataError, match="frame 1 of training drive 0 has no gps"):
        MaxPi(Brightness()).fit([frames])
