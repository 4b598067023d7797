"""An agent from configuration data: a localizer, and the encoder it looks through.

An agent is a table: `localizer` names a localizer plug-in, every other key is one of its constructor's options.
The option `encoder` names an encoder plug-in, or is a table of its `name` and its options. A bare name stands
for a table without options::

    agent = "cohog"
    agent = {localizer = "max-pi", encoder = "log-polar"}
    agent = {localizer = "max-pi", azimuth_width_deg = 10, encoder = {name = "hsd", size = 15, map_size = 30}}
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from typing import Any, TypeAlias, cast

from vprbench.errors import ConfigError, PluginError, VprbenchError
from vprbench.options import check_names, parameters, typed
from vprbench.plugins import Factory, Kind, Plugin, find, missing, one_line, plugins
from vprbench.protocols import Encoder, Localizer

__all__ = ["Config", "build", "build_encoder", "is_seeded", "label", "normalise", "validate"]

# A plug-in's name, or a table of its name and options.
Config: TypeAlias = str | Mapping[str, object]

# The key whose value is the plug-in's name.
_NAME: dict[Kind, str] = {"encoder": "name", "localizer": "localizer"}


def build(config: Config, seed: int = 0, encoder: Encoder | None = None) -> Localizer:
    """The agent that a configuration describes, nothing of it fitted yet (`vprbench.fitted.fitted_agent` fits it too).

    Args:
        config: the agent.
        seed: goes to every part that has a parameter `seed` which the configuration leaves open.
        encoder: to look through instead of making the one that the configuration names: that one, fitted.

    Raises:
        ConfigError: naming the agent, the key and the nearest allowed name or value.
        PluginError: where a plug-in does not load, or what it makes lacks a method.
    """
    with _named(config, "localizer"):
        return cast(Localizer, _parse("localizer", config).make(seed, encoder))


def build_encoder(config: Config, seed: int = 0) -> Encoder:
    """The encoder that a configuration describes, by the rules of `build`."""
    with _named(config, "encoder"):
        return cast(Encoder, _parse("encoder", config).make(seed))


def validate(config: Config, kind: Kind = "localizer") -> None:
    """Raise what `build` would, short of constructing anything."""
    with _named(config, kind):
        _parse(kind, config)


def is_seeded(config: Config, kind: Kind = "localizer") -> bool:
    """Whether the seed matters to an agent or encoder: one that does not take it need run only once."""
    with _named(config, kind):
        return _parse(kind, config).is_seeded


@dataclass(frozen=True)
class _Part:
    """One loaded plug-in of an agent, with checked options and the part it looks through, if any."""

    plugin: Plugin
    factory: Factory
    options: Mapping[str, object]
    encoder: _Part | None

    @property
    def takes_seed(self) -> bool:
        """Whether it has a seed that its configuration leaves open."""
        return "seed" in parameters(self.factory) and "seed" not in self.options

    @property
    def is_seeded(self) -> bool:
        """Whether the seed matters to it or to its encoder."""
        return self.takes_seed or (self.encoder is not None and self.encoder.is_seeded)

    def make(self, seed: int, encoder: Encoder | None = None) -> object:
        """The encoder or localizer itself; a localizer looks through `encoder` where one is given."""
        options = dict(self.options)
        if self.encoder:
            options["encoder"] = self.encoder.make(seed) if encoder is None else encoder
        if self.takes_seed:
            options["seed"] = seed
        try:
            made = self.factory(**options)
        except VprbenchError as error:
            raise ConfigError(f"{self.plugin}: {error}") from error
        except Exception as error:
            raise ConfigError(f"{self.plugin} refuses its options: {one_line(error)}") from error
        if lacks := missing(self.plugin.kind, made):
            raise PluginError(f"{self.plugin} makes a {type(made).__name__} without {', '.join(lacks)}")
        return made


def normalise(config: Config, kind: Kind = "localizer") -> dict[str, Any]:
    """The canonical form of a configuration, for hashing: JSON values, sorted keys, parts always as tables.

    Numbers without a fraction become integers (as in RFC 8785), so that 10 and 10.0 are one configuration.

    Raises:
        ConfigError: where no plug-in is named, or a value is one that no configuration file can hold.
    """
    key = _NAME[kind]
    table = {key: config} if isinstance(config, str) else config
    if not isinstance(table, Mapping) or not isinstance(table.get(key), str):
        raise ConfigError(f"{config!r} names no {kind}: give its name, or a table with the key {key!r}")
    return {
        name: normalise(cast(Config, value), "encoder") if name == "encoder" else _plain(value, name)
        for name, value in sorted(table.items())
    }


def label(config: Config, kind: Kind = "localizer") -> str:
    """A short, unambiguous name that suits a file: `max-pi(hsd[map_size=30,size=15])`."""
    table = normalise(config, kind)
    name, encoder = table.pop(_NAME[kind]), table.pop("encoder", None)
    options = f"[{_text(table)[1:-1]}]" if table else ""
    return _text(name) + options + (f"({label(encoder, 'encoder')})" if encoder else "")


@contextmanager
def _named(config: Config, kind: Kind) -> Iterator[None]:
    """Say which agent or encoder a fault of configuration is in."""
    name = label(config, kind)
    try:
        yield
    except ConfigError as error:
        raise ConfigError(f"{'agent' if kind == 'localizer' else kind} {name}: {error}") from error


def _parse(kind: Kind, config: Config, path: str = "") -> _Part:
    """The parts of a configuration, checked against the signatures of their plug-ins."""
    options = normalise(config, kind)
    plugin = find(kind, options.pop(_NAME[kind]))
    factory = plugin.load()
    known = parameters(factory)
    if "encoder" in known and "encoder" not in options and known["encoder"].default is known["encoder"].empty:
        raise ConfigError(f"{path}encoder is missing: {plugin} needs one of {', '.join(plugins('encoder'))}")
    check_names(factory, options.keys() | ({"seed"} & known.keys()), path, plugin)
    inner = options.pop("encoder", None)
    encoder = _parse("encoder", inner, f"{path}encoder.") if inner else None
    return _Part(plugin, factory, typed(factory, options, path, plugin), encoder)


def _plain(value: object, name: str) -> object:
    """A value of an option as JSON holds it."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 2**53:
        return int(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Mapping):
        return {str(key): _plain(value[key], f"{name}.{key}") for key in sorted(value)}
    if isinstance(value, list | tuple):
        return [_plain(item, name) for item in value]
    raise ConfigError(f"{name} is a {type(value).__name__}, which no configuration file can hold")


def _text(value: object) -> str:
    """A canonical value in a label; text with characters that files dislike carries a hash of itself."""
    if isinstance(value, dict):
        return f"({','.join(f'{key}={_text(item)}' for key, item in value.items())})"
    if isinstance(value, list):
        return f"({','.join(map(_text, value))})"
    if not isinstance(value, str):
        return str(value).lower()
    safe = re.sub(r"[^\w.+-]+", "_", value, flags=re.ASCII)
    return safe if safe == value else f"{safe}-{sha256(value.encode()).hexdigest()[:8]}"
