from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from vprbench.catalogue import catalogue
from vprbench.entries import KittiOdometryEntry
from vprbench.geodesy import wrap
from vprbench.readers.kitti import Motion
from vprbench.readers.number_files import read_numbers
from vprbench.revisits import RevisitRule, RoadTwice, apart, find_revisits, first_runs

# A ring road of 400 m, driven clockwise at 1 m a frame and 10 m/s.
RING = 400
ANGLE = 2 * np.pi / RING


def laps(count: float, aside: float = 0.0, speed: float = 10.0) -> Motion:
    """Laps of the ring, each `aside` metres farther out than the one before."""
    frames = np.arange(int(count * RING))
    radius = RING / (2 * np.pi) + aside * (frames // RING)
    positions = np.stack([radius * np.sin(frames * ANGLE), radius * np.cos(frames * ANGLE)], axis=1)
    return Motion(positions, wrap(frames * ANGLE + np.pi / 2), frames / speed)


def found(motion: Motion, allowed: np.ndarray | None = None, rule: RevisitRule | None = None) -> list[RoadTwice]:
    everywhere = np.ones(len(motion.times), bool)
    return find_revisits(*motion, everywhere if allowed is None else allowed, rule)


def test_the_second_lap_is_one_revisit() -> None:
    # Its first frames come within the radius, 5 m, before the first drive begins.
    assert found(laps(1.5)) == [RoadTwice(range(200), range(395, 600))]


def test_a_lane_beside_is_a_revisit_and_a_street_beside_is_none() -> None:
    assert len(found(laps(1.5, aside=4.5))) == 1
    assert found(laps(1.5, aside=5.5)) == []


def test_driving_back_is_no_revisit() -> None:
    there = laps(1.0)
    back = Motion(there.positions[::-1], wrap(there.headings[::-1] + np.pi), there.times + 100.0)
    assert found(Motion(*(np.concatenate(pair) for pair in zip(there, back, strict=True)))) == []


def test_driving_back_is_a_revisit_of_the_reverse_direction() -> None:
    there = laps(1.0)
    back = Motion(there.positions[::-1], wrap(there.headings[::-1] + np.pi), there.times + 100.0)
    both = Motion(*(np.concatenate(pair) for pair in zip(there, back, strict=True)))
    reverse = RevisitRule(direction="reverse")
    assert found(both, rule=reverse) == [RoadTwice(range(400), range(400, 800))]
    shortcut = Motion(*(values[np.r_[:660, 700:800]] for values in both))
    parts = [RoadTwice(range(140, 400), range(400, 660)), RoadTwice(range(100), range(660, 760))]
    assert found(shortcut, rule=reverse) == parts
    assert found(laps(1.5), rule=reverse) == []


def test_a_turn_in_the_road_is_no_way_back() -> None:
    """Out, round, and back at once: the pause is not over before the two ways part."""
    there = laps(0.6)
    back = Motion(there.positions[::-1], wrap(there.headings[::-1] + np.pi), there.times + 24.0)
    both = Motion(*(np.concatenate(pair) for pair in zip(there, back, strict=True)))
    (twice,) = found(both, rule=RevisitRule(direction="reverse"))
    assert twice.learn[0] == 0
    assert twice.test[-1] == 479
    assert both.times[twice.test[0]] - both.times[twice.learn[-1]] == pytest.approx(30.0, abs=0.2)


def test_a_revisit_needs_its_pause_and_its_length() -> None:
    assert found(laps(1.5, speed=20.0)) == []  # a lap takes 20 s
    assert found(laps(1.1125)) == []  # frames 395-444: 49 m
    assert len(found(laps(1.12))) == 1  # frames 395-447: 52 m


def test_each_lap_is_a_revisit_of_the_nearest_one_before() -> None:
    second, third = found(laps(2.5, aside=1.0))
    assert (second.learn[0], second.learn[-1]) == pytest.approx((0, 397), abs=3)
    assert (second.test[0], second.test[-1]) == pytest.approx((397, 795), abs=3)
    assert third.test[0] == second.test[-1] + 1
    assert (third.learn[0], third.learn[-1], third.test[-1]) == pytest.approx((397, 599, 999), abs=3)


def test_frames_that_are_not_allowed_take_no_part() -> None:
    allowed = np.ones(600, bool)
    allowed[460:540] = False
    parts = [RoadTwice(range(60), range(395, 460)), RoadTwice(range(140, 200), range(540, 600))]
    assert found(laps(1.5), allowed) == parts
    allowed[:] = True
    allowed[:200] = False
    assert found(laps(1.5), allowed) == []


def test_a_standing_vehicle_stays_in_its_revisit() -> None:
    motion = laps(1.5)
    frames = np.concatenate([np.arange(500), np.full(30, 499), np.arange(500, 600)])
    paused = Motion(motion.positions[frames], motion.headings[frames], np.arange(len(frames)) / 10.0)
    assert [twice.test for twice in found(paused)] == [range(395, 630)]


def test_a_single_frame_has_no_revisit() -> None:
    assert found(laps(0.0026)) == []


def test_apart_keeps_its_distance() -> None:
    line = np.stack([np.arange(100.0), np.zeros(100)], axis=1)
    assert np.flatnonzero(~apart(line, [range(50, 52)], 10.0)).tolist() == list(range(40, 62))
    assert apart(line, [], 10.0).all()


def test_first_runs_take_frames_in_order_and_leave_scraps() -> None:
    free = np.array([1, 1, 0, 1, 1, 1, 1, 0, 0, 1, 1, 1, 1, 1], bool)
    assert first_runs(free, 7, 3) == [range(3, 7), range(9, 12)]
    assert first_runs(free, 100, 2) == [range(2), range(3, 7), range(9, 14)]
    assert first_runs(np.zeros(4, bool), 7, 3) == []


def odometry_motion(root: Path, sequence: str) -> Motion:
    """A sequence's motion at its nominal 10 frames a second (the shared part has few time files)."""
    poses = read_numbers(root / "dataset" / "poses" / f"{sequence}.txt", 12)
    return Motion(poses[:, [3, 11]], np.arctan2(poses[:, 2], poses[:, 10]), np.arange(len(poses)) / 10.0)


def entries(*splits: str) -> dict[str, list[KittiOdometryEntry]]:
    """The catalogue's odometry routes by sequence."""
    grouped = defaultdict(list)
    for entry in catalogue().entries.values():
        if isinstance(entry, KittiOdometryEntry) and entry.split in splits:
            grouped[entry.learn.sequence].append(entry)
    return grouped


@pytest.mark.kitti
@pytest.mark.parametrize("sequence", ["00", "02", "05", "06", "07", "09"])
def test_the_tuning_routes_are_the_revisits_off_all_other_routes(kitti_root: Path, sequence: str) -> None:
    motion = odometry_motion(kitti_root, sequence)
    taken = [run.frames for entry in entries("report", "control")[sequence] for run in (entry.learn, entry.test)]
    off = apart(motion.positions, taken, 10.0)
    derived = []
    for twice in found(motion, off):
        free = off & apart(motion.positions, [twice.learn, twice.test], 25.0)
        derived.append((twice.learn, twice.test, first_runs(free, 150, 10)))
    stated = [
        (entry.learn.frames, entry.test.frames, [run.frames for run in entry.training])
        for entry in entries("tuning")[sequence]
    ]
    assert stated == derived


@pytest.mark.kitti
@pytest.mark.parametrize("sequence", ["00", "05"])
def test_the_papers_routes_are_revisits(kitti_root: Path, sequence: str) -> None:
    revisits = found(odometry_motion(kitti_root, sequence))
    for entry in entries("report")[sequence]:
        middle = entry.test.frames[len(entry.test.frames) // 2]
        shared = [set(twice.learn) & set(entry.learn.frames) for twice in revisits if middle in twice.test]
        assert len(shared[0]) >= 0.8 * len(entry.learn.frames), str(entry.test)
