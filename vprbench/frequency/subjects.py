"""Agents with so many places learned, ready to be timed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from copy import deepcopy
from dataclasses import dataclass
from typing import NamedTuple

from vprbench.agents import Config, build, normalise
from vprbench.encoder_store import EncoderStore
from vprbench.errors import PluginError
from vprbench.fitted import fitted_encoder
from vprbench.frequency.filling import Filled, Filling, told
from vprbench.frequency.rehearsal import Rehearsal
from vprbench.observation import Drive
from vprbench.plugins import one_line
from vprbench.protocols import Localizer, Storing
from vprbench.reporting import Report, silent
from vprbench.route import Traverse
from vprbench.types import Landmarks, Observation

__all__ = ["STEP", "VIGILANCE", "Agent", "Subject", "fitted", "make_place", "subjects"]

# What makes every observation of a `Filling` a place: no response is above a vigilance of 1, and its frames lie a
# metre apart.
VIGILANCE, STEP = 1.0, 0.5


class Agent(NamedTuple):
    """A fitted agent.

    Attributes:
        name: in the table.
        localizer: without places.
        rehearsal: the encoder that it looks through; None where it has its own eyes.
    """

    name: str
    localizer: Localizer
    rehearsal: Rehearsal | None


@dataclass(frozen=True)
class Subject:
    """An agent with places.

    Attributes:
        agent: its name.
        places: how many.
        filled_from: where their frames come from, in words.
        localizer: with these places, its own.
        rehearsal: see `Agent`.
    """

    agent: str
    places: int
    filled_from: str
    localizer: Localizer
    rehearsal: Rehearsal | None


def fitted(
    name: str,
    config: Config,
    seed: int,
    training: Sequence[Traverse],
    store: EncoderStore | None = None,
    report: Report = silent,
) -> Agent:
    """The agent of a configuration, fitted as for a sweep; see `vprbench.fitted.fitted_agent`."""
    table, rehearsal = normalise(config), None
    build(config, seed)
    if "encoder" in table:
        encoder, _, _ = fitted_encoder(table["encoder"], seed, training, store, report)
        rehearsal = Rehearsal(encoder)
    localizer = build(config, seed, rehearsal)
    localizer.fit([Drive(drive) for drive in training])
    return Agent(name, localizer, rehearsal)


def subjects(agent: Agent, filling: Filling, sizes: Sequence[int], report: Report = silent) -> Iterator[Subject]:
    """The agent with each of these numbers of places (rising): grown from one to the next, and copied at each.

    It ends early if the agent makes no more places though it is shown every frame.

    Raises:
        PluginError: the localizer cannot be copied.
    """
    sources: list[str] = []
    for filled in _recruited(agent, filling):
        sources.append(filled.source)
        report("learn places", len(sources), sizes[-1])
        if len(sources) in sizes:
            last = len(sources) == sizes[-1]
            localizer = agent.localizer if last else _copy(agent)
            yield Subject(agent.name, len(sources), told(sources), localizer, agent.rehearsal)
            if last:
                return


def _recruited(agent: Agent, filling: Filling) -> Iterator[Filled]:
    """Let the agent learn the filling; each observation that became a place."""
    known: dict[int, Landmarks] = {}
    agent.localizer.clear(VIGILANCE if agent.localizer.recruiting == "vigilance" else STEP)
    index = refused = 0
    while refused < len(filling):
        filled = filling[index]
        with _hurried(agent, filled, known):
            made = make_place(agent.localizer, filled.observation)
        index, refused = index + 1, 0 if made else refused + 1
        if made:
            yield filled


def make_place(localizer: Localizer, observation: Observation) -> bool:
    """Make a place of an observation, without comparing it with others if that can be had; whether there is one."""
    if isinstance(localizer, Storing):
        localizer.store(localizer.describe(observation))
        return True
    return localizer.learn(observation) is not None


def _hurried(agent: Agent, filled: Filled, known: dict[int, Landmarks]) -> AbstractContextManager[None]:
    """While entered, learning costs little: no frame is encoded twice, and none is compared with the places."""
    if agent.rehearsal is None:
        return nullcontext()
    if filled.frame not in known:
        known[filled.frame] = agent.rehearsal.encode(filled.observation["frame"])
    return agent.rehearsal.recalling(known[filled.frame], blank=True)


def _copy(agent: Agent) -> Localizer:
    try:
        return deepcopy(agent.localizer)
    except Exception as error:
        fault = f"{agent.name}: its localizer cannot be copied, so as to be timed with several numbers of places"
        raise PluginError(f"{fault}: {one_line(error)}") from error
