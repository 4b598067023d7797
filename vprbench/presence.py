"""Which of some routes lack data on this machine, and what they lack."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from vprbench.availability import Availability
from vprbench.catalogue import catalogue

__all__ = ["shortfalls"]


def shortfalls(names: Iterable[str], data: Path | None = None, routes_file: Path | None = None) -> dict[str, str]:
    """The routes whose data are not all here, each with what it needs, is there, is missing, and gets it.

    Args:
        names: of routes.
        data: the data root, None for the default.
        routes_file: a TOML with the user's own routes.

    Raises:
        ConfigError: there is no route of such a name.
    """
    known = catalogue(routes_file)
    found = {name: known.availability(name, data) for name in dict.fromkeys(names)}
    return {name: _reason(there) for name, there in found.items() if not there.complete}


def _reason(there: Availability) -> str:
    needs = "; and ".join(map(str, there.wanting))
    return f"{needs}. {there.hint}" if there.hint else needs
