"""What is asked of frequency unless told otherwise: which agents, with how many places, and what the paper says."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.resources import files
from typing import Any

from pydantic import BaseModel, ConfigDict

__all__ = ["PaperPoint", "Question", "default_question"]


class _Data(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class PaperPoint(_Data):
    """A frequency that the paper names.

    Attributes:
        agent: as in the question.
        places: learned.
        hz: queries a second, on the paper's own machine.
    """

    agent: str
    places: int
    hz: float


class Question(_Data):
    """The question, as its TOML states it.

    Attributes:
        places: numbers of places learned, rising.
        rounds: how often each agent is timed with each number of places.
        reference: the agent that others are held against.
        agents: configuration of each agent, by the name it has in the table.
        paper: what the paper found.
    """

    places: tuple[int, ...]
    rounds: int
    reference: str
    agents: dict[str, str | dict[str, Any]]
    paper: tuple[PaperPoint, ...] = ()


@cache
def default_question() -> Question:
    """That of the paper's figure."""
    text = (files("vprbench") / "data" / "frequency.toml").read_text("utf-8")
    return Question.model_validate(tomllib.loads(text))
