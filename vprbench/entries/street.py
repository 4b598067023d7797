"""The catalogue entry for the streets that vprbench draws."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Literal

from pydantic import model_validator

from vprbench.availability import Need
from vprbench.entries.base import Entry
from vprbench.route import Route
from vprbench.street.parameters import StreetParameters

__all__ = ["StreetEntry"]


class StreetEntry(Entry):
    """A drawn street; its keys are those of StreetParameters.

    Attributes:
        parameters: what defines the street and its second drive.
    """

    reader: Literal["street"]
    parameters: StreetParameters

    @model_validator(mode="before")
    @classmethod
    def _gather(cls, table: Any) -> Any:  # noqa: ANN401 - whatever the file holds
        """The table with the street's own keys gathered; the environment is one of them, and the entry's too."""
        if not isinstance(table, dict) or "parameters" in table:
            return table
        names = {field.name for field in fields(StreetParameters)}
        gathered = {key: value for key, value in table.items() if key in names}
        others = {key: value for key, value in table.items() if key not in names}
        environment = table.get("environment", StreetParameters.environment)
        return {**others, "environment": environment, "parameters": gathered}

    def needs(self, root: Path) -> tuple[Need, ...]:
        """Nothing: it is drawn."""
        return ()

    def read(self, name: str, root: Path) -> Route:
        """The route; its frames are drawn when they are asked for."""
        # Drawing needs a compiled renderer, which the other readers should not wait for.
        from vprbench.street import street_route

        return replace(street_route(self.parameters, name=name), split=self.split)
