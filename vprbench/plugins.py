"""The registry: encoders and localizers that installed distributions offer as entry points."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Literal

from vprbench.errors import ConfigError, PluginError, nearest
from vprbench.protocols import Encoder, Localizer

__all__ = ["GROUPS", "Factory", "Kind", "Plugin", "find", "missing", "one_line", "plugins"]

Kind = Literal["encoder", "localizer"]

# Whatever makes an encoder or a localizer from keyword options: a class, a function, a functools.partial.
Factory = Callable[..., object]

# The table `[project.entry-points."..."]` in which a distribution offers each kind.
GROUPS: dict[Kind, str] = {"encoder": "vprbench.encoders", "localizer": "vprbench.localizers"}

_PROTOCOLS: dict[Kind, type] = {"encoder": Encoder, "localizer": Localizer}


@dataclass(frozen=True)
class Plugin:
    """One offered plug-in, not imported yet.

    Attributes:
        name: as configurations call it.
        kind: what it makes.
        distribution: which offers it, for example "acme-vpr".
        version: of that distribution.
        value: where its factory is, "module:attribute".
        rivals: the same name as other distributions offer it.
    """

    name: str
    kind: Kind
    distribution: str
    version: str
    value: str
    rivals: tuple[Plugin, ...] = ()

    def __str__(self) -> str:
        return f"{self.kind} {self.name!r} ({self.origin})"

    @property
    def origin(self) -> str:
        """The distribution and its version, as messages name them."""
        return f"{self.distribution} {self.version}"

    def load(self) -> Factory:
        """Import the factory.

        Raises:
            PluginError: naming the plug-in and its distribution, where it does not import, is nothing to
                call, or is offered by several distributions.
        """
        if self.rivals:
            origins = ", ".join(plugin.origin for plugin in (self, *self.rivals))
            raise PluginError(f"{self.kind} {self.name!r} is offered by {origins}: uninstall all but one")
        try:
            factory: object = EntryPoint(self.name, self.value, GROUPS[self.kind]).load()
        except (Exception, SystemExit) as error:
            raise PluginError(f"{self} does not load from {self.value}: {one_line(error)}") from error
        if not callable(factory):
            raise PluginError(f"{self}: {self.value} is of type {type(factory).__name__}, not a class or function")
        return factory

    def fault(self) -> str | None:
        """Why the plug-in does not load, in one line; None if it does."""
        try:
            self.load()
        except PluginError as error:
            return str(error)
        return None


def plugins(kind: Kind) -> dict[str, Plugin]:
    """Every offered plug-in of a kind, sorted by name; nothing is imported, so none can break the list.

    The distributions are read once for each search path: one that is installed later is seen by the next process.
    """
    offered: dict[str, Plugin] = {}
    for plugin in sorted(_offers(kind, tuple(sys.path)), key=lambda plugin: (plugin.name, plugin.distribution)):
        first = offered.setdefault(plugin.name, plugin)
        if first is not plugin:
            offered[plugin.name] = replace(first, rivals=(*first.rivals, plugin))
    return offered


@cache
def _offers(kind: Kind, path: tuple[str, ...]) -> tuple[Plugin, ...]:
    """Every entry point of a kind on `sys.path`; one that no distribution owns cannot be installed, so is left out."""
    entries = entry_points(group=GROUPS[kind])
    return tuple(Plugin(e.name, kind, e.dist.name, e.dist.version, e.value) for e in entries if e.dist)


def find(kind: Kind, name: str) -> Plugin:
    """The plug-in of that name.

    Raises:
        ConfigError: with the nearest name, where none is called so.
    """
    offered = plugins(kind)
    if name not in offered:
        raise ConfigError(f"no {kind} is called {name!r}: {nearest(name, offered)}")
    return offered[name]


def missing(kind: Kind, made: object) -> list[str]:
    """The attributes that the protocol of a kind asks for and `made` lacks."""
    protocol = _PROTOCOLS[kind]
    asked = vars(protocol).keys() | inspect.get_annotations(protocol).keys()
    return sorted(name for name in asked if not name.startswith("_") and not hasattr(made, name))


def one_line(error: BaseException) -> str:
    """An exception's type and text without line breaks, as a message quotes a cause."""
    return " ".join(f"{type(error).__name__}: {error}".split())
