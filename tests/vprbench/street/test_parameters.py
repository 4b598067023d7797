"""The parameters of a street, and what refusing one says."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.catalogue import catalogue
from vprbench.entries.street import StreetEntry
from vprbench.errors import ConfigError
from vprbench.street import StreetParameters

NUMBERS = [field.name for field in fields(StreetParameters) if field.name != "environment"]


@pytest.mark.parametrize("key", NUMBERS)
@pytest.mark.parametrize("value", [-1e9, 1e12, float("nan"), float("inf")])
def test_a_value_out_of_range_is_refused_by_its_key_and_range(key: str, value: float) -> None:
    changes: dict[str, Any] = {key: value}
    with pytest.raises(ConfigError, match=rf"street: {key} = .*: allowed are .* to .*"):
        StreetParameters(**changes)


@given(st.floats(20, 20_000), st.floats(0, 4), st.floats(-3, 3), st.floats(0, 1), st.floats(0, 180))
def test_every_value_in_range_is_taken_as_it_is(
    length: float, lateral_offset: float, exposure: float, occluders: float, sun_shift: float
) -> None:
    parameters = StreetParameters(
        length=length, lateral_offset=lateral_offset, exposure=exposure, occluders=occluders, sun_shift=sun_shift
    )
    assert (parameters.length, parameters.lateral_offset, parameters.exposure) == (length, lateral_offset, exposure)


def test_an_unknown_environment_gives_the_nearest() -> None:
    with pytest.raises(ConfigError, match="did you mean 'narrow'"):
        StreetParameters(environment="narow")  # type: ignore[arg-type]


def test_a_seed_is_a_whole_number() -> None:
    with pytest.raises(ConfigError, match=r"street: seed = 1\.5: must be a whole number"):
        StreetParameters(seed=1.5)  # type: ignore[arg-type]


def test_the_named_streets_have_the_lengths_of_the_papers_routes() -> None:
    named = {name: entry for name, entry in catalogue().entries.items() if isinstance(entry, StreetEntry)}
    assert {name: entry.parameters for name, entry in named.items()} == {
        "Street-Wide": StreetParameters("wide", 96.0),
        "Street-Narrow": StreetParameters("narrow", 199.0),
        "Street-Mixed": StreetParameters("mixed", 378.0),
    }
