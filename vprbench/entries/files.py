"""Catalogue files: TOML with one table [routes.NAME] a route."""

from __future__ import annotations

import re
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from vprbench.entries import RouteEntry
from vprbench.entries.faults import explain
from vprbench.errors import ConfigError, nearest
from vprbench.toml_files import read_toml

__all__ = ["read_entries"]

_ENTRY: TypeAdapter[RouteEntry] = TypeAdapter(RouteEntry)


def read_entries(path: Path) -> dict[str, RouteEntry]:
    """The entries of a catalogue file by name; ConfigError names the file, the key and the nearest allowed name."""
    tables = read_toml(path)
    unknown = sorted(set(tables) - {"routes"})
    if unknown:
        raise ConfigError(f"{path}: {unknown[0]}: unknown key: {nearest(unknown[0], ['routes'])}")
    routes = tables.get("routes", {})
    if not isinstance(routes, dict):
        raise ConfigError(f"{path}: routes: must hold one table a route, [routes.NAME], not {routes!r}")
    return {name: _entry(path, name, table) for name, table in routes.items()}


def _entry(path: Path, name: str, table: object) -> RouteEntry:
    key = f"{path}: routes.{name}"
    if not re.fullmatch(r"\w[\w.-]*", name, re.ASCII):
        raise ConfigError(f"{key}: a route's name has letters, digits, '_', '-' and '.' only")
    try:
        return _ENTRY.validate_python(table, context={"folder": path.parent})
    except ValidationError as error:
        raise ConfigError(f"{key}{explain(error)}") from error
    except ConfigError as error:
        raise ConfigError(f"{key}: {error}") from error
