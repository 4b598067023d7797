"""Which of some routes lack data on this machine, and what they lack."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from vprbench.catalogue import catalogue

__all__ = ["shortfalls"]


def shortfalls(names: Iterable[str], data: Path | None = None, routes_file: Path | None = None) -> dict[str, str]:
    """The routes whose data are not all here, each with what it needs, what is there and what is missing.

    Args:
        names: of routes.
        data: the data root, None for the default.
        routes_file: a TOML with the user's own routes.

    Raises:
        ConfigError: there is no route of such a name.
    """
    known = catalogue(routes_file)
    found = {name: known.availability(name, data).needs for name in dict.fromkeys(names)}
    return {
        name: "; and ".join(str(need) for need in needs if not need.complete)
        for name, needs in found.items()
        if not all(need.complete for need in needs)
    }
