"""Work that is done a step at a time, so that whoever waits for it can be told how far it is."""

from __future__ import annotations

from collections.abc import Generator
from typing import NamedTuple, TypeAlias, TypeVar

from vprbench.types import LearningStep

__all__ = ["Progress", "Stage", "Work", "finished", "named"]

Result = TypeVar("Result")


class Progress(NamedTuple):
    """How many steps are done, of how many, and what to say of the last one."""

    done: int
    total: int
    note: str = ""


# A generator yields after every step and returns what it made.
Work: TypeAlias = Generator[Progress, None, Result]
Stage: TypeAlias = Generator[LearningStep, None, Result]


def finished(work: Generator[object, None, Result]) -> Result:
    """What the work makes, once all its steps are done."""
    while True:
        try:
            next(work)
        except StopIteration as end:
            return end.value


def named(stage: str, work: Work[Result]) -> Stage[Result]:
    """The work, as a stage of learning."""
    while True:
        try:
            progress = next(work)
        except StopIteration as end:
            return end.value
        yield LearningStep(stage, *progress)
