from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from vprbench.data_checks.pictures import difference_hash, duplicate_findings, look, shared_findings
from vprbench.errors import DataError
from vprbench.route import Camera, Traverse


def scene(seed: int) -> np.ndarray:
    """A smooth random picture."""
    coarse = np.random.default_rng(seed).integers(0, 256, (12, 20), np.uint8)
    return cv2.resize(coarse, (642, 188), interpolation=cv2.INTER_CUBIC)


class Scenes:
    """A picture of its own at each frame, but for those named here; None cannot be read."""

    def __init__(self, seed: int, others: Mapping[int, np.ndarray | None]) -> None:
        self.seed, self.others = seed, others

    def __getitem__(self, index: int) -> np.ndarray:
        frame = self.others.get(index, scene(self.seed + index))
        if frame is None:
            raise DataError(f"{index}.png: the PNG is cut off; fetch the file again")
        return frame.copy()


def drive(name: str, seed: int, others: Mapping[int, np.ndarray | None] | None = None, step: float = 1.0) -> Traverse:
    """Ten frames due north."""
    north = np.arange(10.0)
    positions, camera = np.column_stack([0 * north, step * north]), Camera(372.0, 321.0)
    return Traverse(name, Scenes(seed, others or {}), positions, 0 * north, north, camera, np.arange(10) + 100, name)


@given(arrays(np.int64, (8, 9), elements=st.integers(0, 255)))
def test_a_hash_tells_which_of_two_neighbours_is_darker(areas: np.ndarray) -> None:
    frame = np.kron(areas, np.ones((20, 60), np.int64)).astype(np.uint8)
    assert difference_hash(frame).tolist() == (np.diff(areas, axis=1) > 0).ravel().tolist()


@given(st.integers(0, 50), st.integers(-30, 30), st.floats(0.6, 1.2))
def test_light_changes_few_bits_and_another_scene_many(seed: int, offset: int, gain: float) -> None:
    one = scene(seed) * 0.5 + 60
    lit = np.clip(one * gain + offset, 0, 255).astype(np.uint8)
    assert (difference_hash(one.astype(np.uint8)) != difference_hash(lit)).sum() <= 8
    assert (difference_hash(scene(seed)) != difference_hash(scene(seed + 1000))).sum() > 8


def test_every_frame_that_cannot_be_read_is_found() -> None:
    seen = look(drive("day1", 0, {3: None, 7: None}))
    assert seen.rows.tolist() == [0, 1, 2, 4, 5, 6, 8, 9]
    found = list(seen.findings())
    assert [finding.what for finding in found] == ["3.png: the PNG is cut off", "7.png: the PNG is cut off"]
    assert {(finding.severity, finding.remedy) for finding in found} == {("error", "fetch the file again")}


def test_a_drive_that_cannot_be_read_at_all_is_no_crash() -> None:
    seen = look(drive("day1", 0, dict.fromkeys(range(10))))
    assert len(list(seen.findings())) == 10
    assert list(duplicate_findings([seen, look(drive("day2", 100))])) == []


def test_progress_is_told_frame_by_frame() -> None:
    told: list[tuple[str, int, int]] = []
    look(drive("day1", 0), lambda stage, done, total, note="": told.append((stage, done, total)))
    assert told == [("day1", frame, 10) for frame in range(10)]


def test_a_picture_that_comes_again_elsewhere_is_found() -> None:
    again = np.clip(scene(8).astype(int) + 1, 0, 255).astype(np.uint8)  # not to the bit
    (found,) = duplicate_findings([look(drive("day1", 0, {2: again}))])
    assert (found.severity, found.check, found.where) == ("warning", "duplicate-frames", "day1, frame 102")
    assert found.what == "the same picture as day1, frame 108, 3 m and more away"


@pytest.mark.parametrize(("step", "count"), [(0.2, 0), (1.0, 1)])
def test_a_picture_that_stays_is_found_where_the_vehicle_moves(step: float, count: int) -> None:
    """A camera that hangs films one picture; so does a vehicle that stands."""
    hung = dict.fromkeys(range(4, 10), scene(4))
    found = list(duplicate_findings([look(drive("day1", 0, hung, step))]))
    assert [finding.where for finding in found] == ["day1, frames 104-106"] * count


def test_the_drives_are_compared_with_one_another() -> None:
    one, two = drive("day1", 0), drive("day2", 100, {0: scene(9)})
    assert [finding.where for finding in duplicate_findings([look(one), look(two)])] == ["day1, frame 109"]
    assert list(duplicate_findings([look(one), look(drive("day2", 100))])) == []


def test_a_frame_in_two_drives_is_an_error_wherever_it_was_taken() -> None:
    one, two = look(drive("day1", 0)), look(drive("day2", 100, {9: scene(9)}))
    (found,) = shared_findings([one, two])
    assert (found.severity, found.check, found.where) == ("error", "shared-frames", "day1, frame 109")
    assert found.what == "the very picture of day2, frame 109"
    assert list(shared_findings([one, look(drive("day3", 200))])) == []
