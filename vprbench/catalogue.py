"""The catalogue: named routes, ours and the user's, read from TOML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

from vprbench.availability import Availability
from vprbench.data_root import data_root
from vprbench.entries import RouteEntry, Split
from vprbench.entries.files import read_entries
from vprbench.errors import ConfigError, DataError, nearest
from vprbench.route import Route

__all__ = ["Catalogue", "catalogue", "load_route"]

# Metres. Two lanes of a wide road lie nearer; the drives of two different roads, or of swapped coordinates, do not.
_SAME_ROAD = 50.0


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
            raise ConfigError(f"no route {name!r}: {nearest(name, self.entries)}")
        return self.entries[name]

    def availability(self, name: str, data: Path | str | None = None) -> Availability:
        """What a route needs and what of it is there, by listing folders alone."""
        return Availability(name, self.entry(name).needs(data_root(data)))

    def load(self, name: str, data: Path | str | None = None) -> Route:
        """The route, with lazy frames; DataError says which files are missing and how to get them."""
        entry, root = self.entry(name), data_root(data)
        Availability(name, entry.needs(root)).require()
        route = entry.load(name, root)
        _check_same_road(route)
        return route


def catalogue(routes: Path | str | None = None) -> Catalogue:
    """The built-in routes and, where a TOML file is named, the user's."""
    built_in = _built_in()
    if routes is None:
        return built_in
    own = read_entries(Path(routes))
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
        return Catalogue(read_entries(path))


def _check_same_road(route: Route) -> None:
    if route.truth is not None:
        if not route.truth.answers.any():
            raise DataError(f"{route.name}: no test frame has a right learn frame ({route.truth.rule}); check its data")
        return
    closest = route.visit.tolerance.min()
    if closest > _SAME_ROAD:
        raise DataError(
            f"{route.name}: {route.test.name} never comes nearer than {closest:.0f} m to {route.learn.name}; "
            "check their positions, or choose two drives along one road"
        )
