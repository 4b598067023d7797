"""TOML files that people write: whatever is wrong with one is a ConfigError that names it."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from vprbench.errors import ConfigError, DataError
from vprbench.readers.number_files import read_text

__all__ = ["parse_toml", "read_toml", "toml_text"]


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file; ConfigError where it cannot be read or is none."""
    return parse_toml(toml_text(path), str(path))


def toml_text(path: Path) -> str:
    """The text of a TOML file, to be parsed or kept; ConfigError where it cannot be read."""
    try:
        return read_text(path)
    except DataError as error:
        raise ConfigError(str(error)) from error


def parse_toml(text: str, where: str) -> dict[str, Any]:
    """The tables in a text; ConfigError, beginning with `where`, names the line of what is no TOML."""
    try:
        return tomllib.loads(text)
    except RecursionError as error:
        raise ConfigError(f"{where}: not TOML that can be read: brackets within brackets too deep") from error
    except ValueError as error:  # TOMLDecodeError, and a number of more digits than Python reads
        raise ConfigError(f"{where}: not TOML: {error}") from error
