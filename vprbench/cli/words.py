"""Plug-in configurations as they are written on a command line."""

from __future__ import annotations

import tomllib
from typing import Any

from vprbench.agents import Config
from vprbench.errors import ConfigError

__all__ = ["plugin_config"]


def plugin_config(text: str, what: str) -> Config:
    """A configuration: a bare name, or the inside of a TOML table; `what` is what messages call it."""
    if "=" not in text:
        return text
    try:
        table: dict[str, Any] = tomllib.loads(f"it = {{{text}}}")["it"]
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{what} {text!r}: not the inside of a TOML table: {error}") from error
    return table
