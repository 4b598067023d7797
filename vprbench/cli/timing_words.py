"""The agents and numbers of places to be timed, as they are written on the command line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from vprbench.agents import Config, label, validate
from vprbench.cli.words import plugin_config
from vprbench.errors import ConfigError, nearest
from vprbench.frequency.question import Question
from vprbench.plugins import plugins

__all__ = ["asked_agents", "asked_places"]


def asked_agents(texts: Sequence[str], question: Question) -> Iterator[tuple[str, Config]]:
    """Each agent by its name in the table, checked before anything runs: those of the paper, if none is given.

    Raises:
        ConfigError: one is not known, or has a fault in its table.
    """
    known = {_plain(name): (name, config) for name, config in question.agents.items()}
    for text in texts or question.agents:
        name, config = known.get(_plain(text)) or (None, plugin_config(text, "agent"))
        if name is None and isinstance(config, str) and config not in plugins("localizer"):
            raise ConfigError(f"no agent {text!r}: {nearest(_plain(text), {*known, *plugins('localizer')})}")
        validate(config)
        yield name or label(config), config


def asked_places(text: str) -> list[int]:
    """Numbers of places, rising.

    Raises:
        ConfigError: the text is none, or one is below 1.
    """
    try:
        sizes = sorted({int(number) for number in text.split(",")})
    except ValueError:
        sizes = []
    if not sizes or sizes[0] < 1:
        raise ConfigError(f"--places {text!r}: give whole numbers from 1 on with commas between, for example 10,100")
    return sizes


def _plain(name: str) -> str:
    """A name however it is written: "HSD-15/30" and "hsd-15-30" are one."""
    return name.lower().replace("/", "-")
