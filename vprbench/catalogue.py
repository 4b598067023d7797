"""The catalogue: named routes, ours and the user's, read from TOML."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from vprbench.availability import Availability
from vprbench.data_root import data_root
from vprbench.entries import RouteEntry, Split
from vprbench.errors import ConfigError, nearest
from vprbench.route import Route

__all__ = ["Catalogue", "catalogue", "load_route"]


@dataclass(frozen=True)
class Catalogue:
    """Routes by name."""

    entries: Mapping[str, RouteEntry]

    def names(self, split: Split | None = None) -> tuple[str, ...]:
        """The names of all routes, or of those of one split, in catalogue order."""
        return tuple(n for n, entry in self.entries.items() if split in (None, entry.split))

    def entry(self, name: str) -> RouteEntry:
        """What the catalogue says of a route; ConfigError, with the nearest name, where it has none."""
        if name not in self.entries:
            raise ConfigError(f"no route {name!r} {nearest(name, self.entries)}")
        return self.entries[name]

    def availability(self, name: str, data: Path | str | None = None) -> Availability:
        """What a route needs and what of it is there, by listing folders alone."""
        return Availability(name, self.entry(name).needs(data_root(data)))

    def load(self, name: str, data: Path | str | None = None) -> Route:
        """The route, with lazy frames; DataError says which files are missing and how to get them."""
        entry, root = self.entry(name), data_root(data)
        Availability(name, entry.needs(root)).require()
        return entry.load(name, root)


def catalogue(routes: Path | str | None = None) -> Catalogue:
    """The built-in routes and, where a TOML file is named, the user's."""
    built_in = _built_in()
    if routes is None:
        return built_in
    own = _read(Path(routes))
    taken = sorted(set(own) & set(built_in.entries))
    if taken:
        raise ConfigError(f"{routes}: routes.{taken[0]}: the name of a built-in route; choose another")
    return Catalogue({**built_in.entries, **own})


def load_route(name: str, data: Path | str | None = None, routes: Path | str | None = None) -> Route:
    """A route by its name.

    Args:
        name: as in `vprbench list`.
        data: the data root (default: `VPRBENCH_DATA`, else the user's data folder).
        routes: a TOML file with routes of the user's own.
    """
    return catalogue(routes).load(name, data)


@cache
def _built_in() -> Catalogue:
    with resources.as_file(resources.files("vprbench") / "data" / "routes.toml") as path:
        return Catalogue(_read(path))


def _read(path: Path) -> dict[str, RouteEntry]:
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read ({error})") from error
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{path}: not TOML: {error}") from error
    unknown = sorted(set(tables) - {"routes"})
    if unknown:
        raise ConfigError(f"{path}: {unknown[0]}: unknown key; {nearest(unknown[0], ['routes'])}")
    return {name: _entry(path, name, table) for name, table in tables.get("routes", {}).items()}


def _entry(path: Path, name: str, table: Any) -> RouteEntry:  # noqa: ANN401 - whatever the file holds
    key = f"{path}: routes.{name}"
    if not re.fullmatch(r"\w[\w.-]*", name, re.ASCII):
        raise ConfigError(f"{key}: a route's name has letters, digits, '_', '-' and '.' only")
    try:
        return TypeAdapter(RouteEntry).validate_python(table, context={"folder": path.parent})
    except ValidationError as error:
        raise ConfigError(f"{key}{_fault(error)}") from error


def _fault(error: ValidationError) -> str:
    return str(error)
