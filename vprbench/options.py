"""A factory's options: named, typed and checked against its own signature."""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterable, Iterator, Mapping
from enum import Enum
from typing import Any, Literal, get_args, get_origin

from pydantic import ConfigDict, ValidationError, create_model
from pydantic_core import ErrorDetails

from vprbench.errors import ConfigError, nearest
from vprbench.plugins import Factory

__all__ = ["check_names", "parameters", "typed"]


def parameters(factory: Factory) -> dict[str, inspect.Parameter]:
    """The parameters that a factory takes by name, their annotations resolved where they can be."""
    named = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    return {p.name: p for p in _signature(factory).parameters.values() if p.kind in named}


def check_names(factory: Factory, names: Iterable[str], path: str, owner: object) -> None:
    """Refuse option names that the factory does not know, and required ones that are not given.

    Args:
        factory: a class, a function or a functools.partial.
        names: of the options given.
        path: where the options stand in the configuration: "", or "encoder." for example.
        owner: says in messages whose options they are.

    Raises:
        ConfigError: naming the key and the nearest allowed one.
    """
    given = set(names)
    known = parameters(factory)
    unknown = sorted(given - known.keys())
    if unknown and not _takes_any(factory):
        raise ConfigError(f"{path}{unknown[0]} is not an option of {owner}: {nearest(unknown[0], known)}")
    for name, parameter in known.items():
        if parameter.default is parameter.empty and name not in given:
            raise ConfigError(f"{path}{name} is missing: {owner} has no default for it")


def typed(factory: Factory, options: Mapping[str, object], path: str, owner: object) -> dict[str, object]:
    """The options as the factory's annotations type them, checked strictly as JSON.

    A whole number serves as a float and a list as a tuple, but text never becomes a number. An option whose
    annotation cannot be resolved passes unchecked. Arguments are those of `check_names`.

    Raises:
        ConfigError: naming the key, its value and what is allowed.
    """
    known = parameters(factory)
    return {
        key: _typed(known[key].annotation, value, f"{path}{key}", owner) if key in known else value
        for key, value in options.items()
    }


def _signature(factory: Factory) -> inspect.Signature:
    """The signature, with text for annotations where a type is imported for the type checker only."""
    try:
        return inspect.signature(factory, eval_str=True)
    except (AttributeError, NameError):
        return inspect.signature(factory)
    except ValueError:  # compiled, and so without one: it takes no options
        return inspect.Signature()


def _takes_any(factory: Factory) -> bool:
    return any(p.kind is p.VAR_KEYWORD for p in _signature(factory).parameters.values())


def _typed(annotation: Any, value: object, path: str, owner: object) -> object:  # noqa: ANN401
    """One value as its annotation types it."""
    if annotation is inspect.Parameter.empty or isinstance(annotation, str):
        return value
    config = ConfigDict(strict=True, arbitrary_types_allowed=True)
    option = create_model("Option", __config__=config, value=(annotation, ...))
    try:
        return dict(option.model_validate_json(json.dumps({"value": value})))["value"]
    except ValidationError as error:
        raise ConfigError(_explain(annotation, error.errors(), path, owner)) from error


def _explain(annotation: object, faults: list[ErrorDetails], path: str, owner: object) -> str:
    """What one value should have been, in one line."""
    fault = faults[0]
    kinds = {fault["type"] for fault in faults}
    if "needs_python_object" in kinds:
        return f"{path} of {owner} takes an object that no configuration can hold"
    if kinds <= {"literal_error", "enum"}:
        should = nearest(str(fault["input"]), map(str, _choices(annotation)))
    else:
        should = " or ".join(fault["msg"].removeprefix("Input ") for fault in faults)
    index = "".join(f"[{key}]" for key in fault["loc"][1:]) if len(faults) == 1 else ""
    return f"{path}{index} = {fault['input']!r} of {owner}: {should}"


def _choices(annotation: object) -> Iterator[object]:
    """The values that an annotation enumerates, however deep in it."""
    if get_origin(annotation) is Literal:
        yield from get_args(annotation)
    elif isinstance(annotation, type) and issubclass(annotation, Enum):
        yield from (member.value for member in annotation)
    else:
        for part in get_args(annotation):
            yield from _choices(part)
