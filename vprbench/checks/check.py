"""A named check, and how it fails."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Generic, TypeVar
from unittest import SkipTest

from vprbench.errors import PluginError

__all__ = ["Check", "CheckFailed", "DoesNotApply", "Suite", "expect"]

Subject = TypeVar("Subject")


class CheckFailed(PluginError, AssertionError):
    """A plug-in does otherwise than its protocol asks; the text says what is asked, in one line."""


class DoesNotApply(SkipTest):
    """A check asks for what the protocol leaves open and this plug-in does not offer; pytest reports it as skipped."""


@dataclass(frozen=True)
class Check:
    """One thing that a protocol asks of a plug-in.

    Attributes:
        name: the demand in a few words, "match-lies-in-0-1" for example.
        run: raises `CheckFailed`, or whatever the plug-in itself raises, or `DoesNotApply`; returns nothing if all is
            well.
    """

    name: str
    run: Callable[[], None]


def expect(kept: bool, demand: str) -> None:
    """Fail the check unless the demand is kept."""
    if not kept:
        raise CheckFailed(demand)


class Suite(Generic[Subject]):
    """The checks of one protocol, in the order they were added."""

    def __init__(self) -> None:
        self._demands: list[Callable[[Subject], None]] = []

    def add(self, demand: Callable[[Subject], None]) -> Callable[[Subject], None]:
        """Decorate a function that checks one demand; its name becomes the check's."""
        self._demands.append(demand)
        return demand

    def checks(self, subject: Subject) -> Iterator[Check]:
        """Every check, to be run on this subject."""
        for demand in self._demands:
            yield Check(demand.__name__.strip("_").replace("_", "-"), partial(demand, subject))
