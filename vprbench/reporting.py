"""Progress as those who work tell it to those who show it."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

__all__ = ["Report", "part_of", "silent"]


@runtime_checkable
class Report(Protocol):
    """Called with what is being done, how much of it is done, how much there is, and what to say of it."""

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Take note of it."""
        ...


def silent(stage: str, done: int, total: int, note: str = "") -> None:
    """A report to nobody."""


def part_of(report: Report, before: int, whole: int) -> Report:
    """A report of a part, told on as that of the whole.

    Args:
        report: of the whole.
        before: how much of it is done when the part begins.
        whole: how much there is of it.
    """

    def tell(stage: str, done: int, total: int, note: str = "") -> None:
        report(stage, before + done, whole, note)

    return tell
