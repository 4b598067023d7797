"""Routes proposed where a recording drives a road twice, as a catalogue file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from vprbench.recordings import Recording
from vprbench.revisits import Direction, RevisitRule, RoadTwice, apart, find_revisits, first_runs
from vprbench.truth import revisit

__all__ = ["Proposal", "propose", "to_toml"]

# Metres that training frames keep off both drives, how many frames there should be, as in the paper, and in runs of at
# least how many. Our choice but for the second.
_OFF, _TRAINING, _SHORTEST = 10.0, 150, 10


@dataclass(frozen=True)
class Proposal:
    """A route on one recording.

    Attributes:
        name: of the route.
        direction: of the test drive, as the learn drive's or back.
        learn: frames of the learn drive, counted from the recording's first.
        test: those of the test drive.
        training: runs of frames farther than 10 m from both.
        metres: the length of the learn and of the test drive.
        distance: d_NN of the test frames: mean, standard deviation, maximum, metres.
    """

    name: str
    direction: Direction
    learn: range
    test: range
    training: tuple[range, ...]
    metres: tuple[float, float]
    distance: tuple[float, float, float]


def propose(recording: Recording, directions: Sequence[Direction], shortest: float = 50.0) -> list[Proposal]:
    """A route for every road of at least `shortest` metres that a recording drives twice, direction by direction."""
    everywhere = np.ones(len(recording.motion.times), bool)
    found = []
    for direction in directions:
        letter = "R" if direction == "reverse" else ""
        rule = RevisitRule(length=shortest, direction=direction)
        for number, twice in enumerate(find_revisits(*recording.motion, everywhere, rule), 1):
            found.append(_proposal(recording, f"Revisit-{recording.name}-{letter}{number}", direction, twice))
    return found


def to_toml(recording: Recording, proposals: Sequence[Proposal]) -> str:
    """A catalogue file with these routes, each with its figures as a comment."""
    many = f"{len(proposals)} roads" if len(proposals) != 1 else "one road"
    head = f"# Revisits in {recording.name}, found from its positions alone: {many} driven twice.\n"
    return "\n".join([head, *("\n".join(_table(recording, proposal)) for proposal in proposals)])


def _proposal(recording: Recording, name: str, direction: Direction, twice: RoadTwice) -> Proposal:
    positions = recording.motion.positions
    road = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))])
    gaps = revisit(positions[twice.learn], positions[twice.test]).tolerance
    free = apart(positions, [twice.learn, twice.test], _OFF)
    metres = [float(road[drive[-1]] - road[drive[0]]) for drive in (twice.learn, twice.test)]
    return Proposal(
        name=name,
        direction=direction,
        learn=twice.learn,
        test=twice.test,
        training=tuple(first_runs(free, _TRAINING, _SHORTEST)),
        metres=(metres[0], metres[1]),
        distance=(float(gaps.mean()), float(gaps.std()), float(gaps.max())),
    )


def _table(recording: Recording, proposal: Proposal) -> Iterator[str]:
    """The lines of one route."""
    way = "the same way" if proposal.direction == "same" else "back"
    learn, test = proposal.metres
    mean, sd, most = proposal.distance
    yield f"# {len(proposal.learn)} frames along {learn:.1f} m, then {len(proposal.test)} along {test:.1f} m {way}."
    yield f"# From a test frame to the nearest learn frame: {mean:.2f} m, sd {sd:.2f} m, at most {most:.2f} m."
    yield f"[routes.{proposal.name}]"
    yield f'reader = "{recording.reader}"'
    for key, frames in (("learn", proposal.learn), ("test", proposal.test)):
        yield f"{key} = {json.dumps(recording.written(frames))}"
    if proposal.training:
        yield f"training = {json.dumps([recording.written(run) for run in proposal.training])}"
    for key, value in recording.options.items():
        yield f"{key} = {value}"
    yield ""
