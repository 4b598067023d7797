"""Revisits: where a recording drives a road again, the same way or back, found from its poses alone."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float64, Int64

from vprbench.geodesy import wrap

__all__ = ["Direction", "RevisitRule", "RoadTwice", "apart", "find_revisits", "first_runs"]


Direction = Literal["same", "reverse"]


@dataclass(frozen=True)
class RoadTwice:
    """Two drives along one road in one recording.

    Attributes:
        learn: the frames of the first.
        test: the frames of the second.
    """

    learn: range
    test: range


@dataclass(frozen=True)
class RevisitRule:
    """What counts as a revisit; all defaults are our choice.

    Attributes:
        radius: largest distance of the second drive from the first, metres.
        turn: largest difference of their headings, radians; of the reverse direction, from half a turn.
        pause: least time between them, seconds.
        length: least length of the second drive, metres.
        jump: how far the partner may move on between two frames of the second drive, metres of road.
        direction: of the second drive: the same, or the reverse, in which partners move back along the first.
    """

    radius: float = 5.0
    turn: float = np.pi / 4
    pause: float = 30.0
    length: float = 50.0
    jump: float = 10.0
    direction: Direction = "same"

    @property
    def sign(self) -> int:
        """1 where partners move on along the first drive, -1 where they move back."""
        return 1 if self.direction == "same" else -1


def find_revisits(
    positions: Float64[np.ndarray, "n 2"],
    headings: Float64[np.ndarray, " n"],
    times: Float64[np.ndarray, " n"],
    allowed: Bool[np.ndarray, " n"],
    rule: RevisitRule | None = None,
) -> list[RoadTwice]:
    """Every revisit in a recording, in the order of its second drives.

    A frame's partner is the nearest of the earlier frames that the rule lets it have. A revisit is a longest
    run of frames whose partners move on along the first drive (of the reverse direction: move back), without a
    step the other way and without a jump, and lie before the run. It begins and ends up to `radius` outside the
    first drive.

    Args:
        positions: (n, 2) metres.
        headings: (n,) radians.
        times: (n,) seconds, increasing.
        allowed: (n,) frames that may be part of a revisit.
        rule: what counts as one; None for the defaults.
    """
    rule = rule or RevisitRule()
    partners = _partners(positions, headings, times, allowed, rule)
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    road = np.concatenate([[0.0], np.cumsum(steps)])
    found = [RoadTwice(_span(partners[run][:: rule.sign]), _span(run)) for run in _steady(partners, road, rule)]
    return [twice for twice in found if road[twice.test[-1]] - road[twice.test[0]] >= rule.length]


def apart(positions: Float64[np.ndarray, "n 2"], drives: Iterable[range], distance: float) -> Bool[np.ndarray, " n"]:
    """Which frames of a recording lie farther than `distance`, metres, from every frame of these drives."""
    far = np.ones(len(positions), bool)
    for frame in (frame for drive in drives for frame in drive):
        far &= np.linalg.norm(positions - positions[frame], axis=1) > distance
    return far


def first_runs(free: Bool[np.ndarray, " n"], count: int, shortest: int) -> list[range]:
    """Runs of at least `shortest` free frames, from the first on, until they have `count` frames together."""
    frames = np.flatnonzero(free)
    runs: list[range] = []
    for run in map(_span, np.split(frames, np.flatnonzero(np.diff(frames) > 1) + 1) if frames.size else []):
        taken = run[: count - sum(map(len, runs))]
        if len(taken) >= shortest:
            runs.append(taken)
    return runs


def _partners(
    positions: Float64[np.ndarray, "n 2"],
    headings: Float64[np.ndarray, " n"],
    times: Float64[np.ndarray, " n"],
    allowed: Bool[np.ndarray, " n"],
    rule: RevisitRule,
) -> Int64[np.ndarray, " n"]:
    """The partner of each frame, -1 for none."""
    partners = np.full(len(positions), -1)
    earlier = np.searchsorted(times, times - rule.pause, side="right")
    for frame in np.flatnonzero(allowed & (earlier > 0)):
        before = slice(0, earlier[frame])
        gaps = np.linalg.norm(positions[before] - positions[frame], axis=1)
        ahead = headings[frame] if rule.direction == "same" else headings[frame] + np.pi
        alike = np.abs(wrap(headings[before] - ahead)) < rule.turn
        gaps[~(alike & allowed[before])] = np.inf
        nearest = int(gaps.argmin())
        if gaps[nearest] <= rule.radius:
            partners[frame] = nearest
    return partners


def _steady(
    partners: Int64[np.ndarray, " n"], road: Float64[np.ndarray, " n"], rule: RevisitRule
) -> list[Int64[np.ndarray, " run"]]:
    """Longest runs of frames whose partners move on steadily."""
    frames = np.flatnonzero(partners >= 0)
    onward = rule.sign * np.diff(road[partners[frames]])
    breaks = (np.diff(frames) > 1) | (rule.sign * np.diff(partners[frames]) < 0) | (onward > rule.jump)
    runs = np.split(frames, np.flatnonzero(breaks) + 1) if frames.size else []
    # On the way back the first partner is the last frame learned, and lies before the run by the pause.
    return [part for run in runs for part in (_unshared(run, partners) if rule.sign > 0 else [run])]


def _unshared(
    run: Int64[np.ndarray, " run"], partners: Int64[np.ndarray, " n"]
) -> Iterator[Int64[np.ndarray, " part"]]:
    """Parts of a run that end before their partners reach the part's own frames, as laps of a ring road do."""
    while run.size:
        own = int(np.searchsorted(partners[run], run[0]))
        yield run[:own]
        run = run[own:]


def _span(frames: Int64[np.ndarray, " run"]) -> range:
    return range(int(frames[0]), int(frames[-1]) + 1)
