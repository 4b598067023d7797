"""Options held against the signatures of all kinds of factories."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import pytest
from pydantic import Field

from vprbench.errors import ConfigError
from vprbench.options import check_names, parameters, typed

if TYPE_CHECKING:
    from somewhere import Unresolved  # type: ignore[import-not-found]


class Colour(Enum):
    RED = "red"
    GREEN = "green"


@dataclass
class Plain:
    size: int
    width: float = 1.0


class Slotted:
    def __call__(self, size: int) -> None:
        """An object that is called."""


def unresolved(size: int, other: Unresolved = None) -> None:
    """Annotated with a type that only the type checker knows."""


def bare(size, *rest, width=1.0):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN002, ANN201
    """Not annotated at all."""


@pytest.mark.parametrize(
    ("factory", "names"),
    [
        (Plain, ["size", "width"]),
        (partial(Plain, 3), ["width"]),
        (partial(Plain, size=3), ["size", "width"]),
        (Slotted(), ["size"]),
        (unresolved, ["size", "other"]),
        (bare, ["size", "width"]),
        (lambda size, /, **options: None, []),
        (dict, []),  # has no signature
    ],
)
def test_parameters_are_those_that_go_by_name(factory: Callable[..., object], names: list[str]) -> None:
    assert list(parameters(factory)) == names


def made(annotation: object, value: object) -> object:
    """The value that a factory with one option of this annotation is given."""

    def factory(option: object) -> None: ...

    factory.__annotations__["option"] = annotation
    return typed(factory, {"option": value}, "", "it")["option"]


@pytest.mark.parametrize(
    ("annotation", "value", "expected"),
    [
        (float, 1, 1.0),
        (float, inf, inf),
        (float | None, None, None),
        (int | str, "3", "3"),
        (tuple[float, float], [2, 4], (2.0, 4.0)),
        (tuple[int, ...], [], ()),
        (Literal["l1", 2], 2, 2),
        (Colour, "red", Colour.RED),
        (dict[str, float], {"a": 1}, {"a": 1.0}),
        (Annotated[float, Field(gt=0)], 2, 2.0),
        (Plain, {"size": 3}, Plain(3)),
        ("Nowhere", "as it is", "as it is"),
        (Any, [1], [1]),
    ],
)
def test_a_value_takes_the_annotated_type(annotation: object, value: object, expected: object) -> None:
    given = made(annotation, value)
    assert given == expected
    assert type(given) is type(expected)


@pytest.mark.parametrize(
    ("annotation", "value", "message"),
    [
        (int, "15", "option = '15' of it: should be a valid integer"),
        (int, 1.5, "option = 1.5 of it: should be a valid integer"),
        (int, True, "option = True of it: should be a valid integer"),
        (float, "1", "option = '1' of it: should be a valid number"),
        (float, False, "option = False of it: should be a valid number"),
        (bool, 1, "option = 1 of it: should be a valid boolean"),
        (Annotated[float, Field(gt=0)], -1, "option = -1 of it: should be greater than 0"),
        (tuple[float, float], [1, "x"], "option[1] = 'x' of it: should be a valid number"),
        (dict[str, int], {"a": "b"}, "option[a] = 'b' of it: should be a valid integer"),
        (int | tuple[int, int], "x", "option = 'x' of it: should be a valid integer or should be a valid"),
        (Literal["cosine", "l1"], "cosin", "option = 'cosin' of it: did you mean 'cosine'? (allowed: cosine, l1)"),
        (Literal["cosine", "l1"] | None, "l2", "did you mean 'l1'? (allowed: cosine, l1)"),
        (list[Literal["a", "b"]], ["a", "z"], "option[1] = 'z' of it: (allowed: a, b)"),
        (Colour, "gren", "option = 'gren' of it: did you mean 'green'? (allowed: green, red)"),
        (np.random.Generator, 3, "option of it takes an object that no configuration can hold"),
    ],
)
def test_a_value_that_does_not_fit_is_told_what_would(annotation: object, value: object, message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)):
        made(annotation, value)


def test_an_option_that_cannot_be_resolved_passes_unchecked() -> None:
    assert typed(unresolved, {"other": [1]}, "", "it") == {"other": [1]}


def test_a_factory_that_takes_anything_gets_anything() -> None:
    def anything(size: int, **options: object) -> None: ...

    check_names(anything, ["size", "colour"], "", "it")
    assert typed(anything, {"size": 1, "colour": "red"}, "", "it") == {"size": 1, "colour": "red"}


def test_unknown_and_missing_names_are_told_apart() -> None:
    with pytest.raises(ConfigError, match=re.escape("encoder.sise is not an option of it: did you mean 'size'?")):
        check_names(Plain, ["sise"], "encoder.", "it")
    with pytest.raises(ConfigError, match=re.escape("encoder.size is missing: it has no default for it")):
        check_names(Plain, ["width"], "encoder.", "it")
    check_names(Plain, ["size"], "encoder.", "it")
