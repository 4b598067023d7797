"""What defines a drawn street and how its second drive differs from the first."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from types import MappingProxyType
from typing import Literal, get_args

from vprbench.errors import ConfigError, nearest

__all__ = ["Environment", "StreetParameters"]

Environment = Literal["wide", "narrow", "mixed"]

# Lowest and highest allowed value, and its unit.
_RANGES: Mapping[str, tuple[float, float, str]] = MappingProxyType(
    {
        "length": (20.0, 20_000.0, "m"),
        "seed": (0, 2**31 - 1, ""),
        "lateral_offset": (0.0, 4.0, "m"),
        "exposure": (-3.0, 3.0, "stops"),
        "occluders": (0.0, 1.0, ""),
        "sun_shift": (0.0, 180.0, "degrees"),
        "noise": (0.0, 64.0, "grey levels"),
        "learn_step": (0.2, 5.0, "m"),
        "test_step": (0.2, 5.0, "m"),
    }
)


@dataclass(frozen=True)
class StreetParameters:
    """One drawn street and the difficulty of its second drive; all defaults are our choice.

    Attributes:
        environment: "wide" (far facades, trees), "narrow" (facades and parked cars close by) or
            "mixed" (sections of both, with proper bends).
        length: of the drive, metres.
        seed: which street of its kind.
        lateral_offset: how far the second drive keeps to the left of the first, metres.
        exposure: how much brighter the second drive is exposed, stops (factors of two).
        occluders: share of the kerb that is parked anew between the drives, and moving cars on 40 m of road
            on the second.
        sun_shift: how far the sun has turned between the drives, degrees of azimuth.
        noise: standard deviation of the sensor noise of the second drive, grey levels.
        learn_step: mean distance between frames of the first drive, metres.
        test_step: mean distance between frames of the second drive, metres.
    """

    environment: Environment = "mixed"
    length: float = 378.0
    seed: int = 0
    lateral_offset: float = 0.6
    exposure: float = 0.5
    occluders: float = 0.4
    sun_shift: float = 30.0
    noise: float = 4.0
    learn_step: float = 1.0
    test_step: float = 1.25

    def __post_init__(self) -> None:
        """Refuse values out of range, each with its key and what is allowed."""
        if self.environment not in get_args(Environment):
            allowed = nearest(str(self.environment), get_args(Environment))
            raise ConfigError(f"street: unknown environment {self.environment!r}: {allowed}")
        for key, (low, high, unit) in _RANGES.items():
            value = getattr(self, key)
            if not (math.isfinite(value) and low <= value <= high):
                raise ConfigError(f"street: {key} = {value}: allowed are {low} to {high} {unit}".rstrip())
        if self.seed != int(self.seed):
            raise ConfigError(f"street: seed = {self.seed}: must be a whole number")

    def __str__(self) -> str:
        return ", ".join(f"{key}={value}" for key, value in asdict(self).items())
