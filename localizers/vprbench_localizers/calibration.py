"""The recognition threshold: how alike landmarks of different places look by chance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from jaxtyping import Float32, Float64

from vprbench.errors import ConfigError, DataError
from vprbench.protocols import Encoder
from vprbench.types import Observation

__all__ = ["Calibration"]


@dataclass(frozen=True)
class _Sample:
    """One training frame: its landmarks, and where it was taken."""

    drive: int
    position: Float64[np.ndarray, "2"]
    signatures: Float32[np.ndarray, "points size"]


@dataclass(frozen=True)
class Calibration:
    """The rule that sets the recognition threshold, the same for every encoder; its values are our choice.

    Attributes:
        percentile: of the matches between landmarks of different places, 0..100.
        apart: two frames of one drive are different places when further apart than this, metres; frames of
            different drives always are.
        frames: at most so many training frames are compared, evenly spaced over all drives.
    """

    percentile: float = 90.0
    apart: float = 25.0
    frames: int = 60

    def __post_init__(self) -> None:
        """Refuse values by which no threshold could be found."""
        if not 0 <= self.percentile <= 100:
            raise ConfigError(f"recognition threshold: the percentile must be 0..100, not {self.percentile}")
        if not self.apart >= 0:
            raise ConfigError(f"recognition threshold: places cannot be {self.apart} m apart; give 0 or more")
        if not self.frames >= 2:
            raise ConfigError(f"recognition threshold: at least 2 frames are compared, not {self.frames}")

    def threshold(self, encoder: Encoder, drives: Sequence[Sequence[Observation]]) -> float:
        """The match that only 100 - percentile per cent of landmark pairs of different places exceed.

        Raises:
            DataError: no two training frames with landmarks show different places, or those places look all
                the same to the encoder.
        """
        matches = [
            encoder.match(one.signatures, other.signatures).ravel()
            for one, other in combinations(self._samples(encoder, drives), 2)
            if self._different(one, other)
        ]
        if not sum(map(len, matches)):
            raise DataError(
                f"recognition threshold: the training drives show no two places more than {self.apart:g} m apart;"
                " give longer drives, or recognition_threshold"
            )
        threshold = float(np.percentile(np.concatenate(matches), self.percentile))
        if not threshold < 1:
            raise DataError(
                f"recognition threshold: {type(encoder).__name__} matches different training places with"
                f" {threshold:g}; give more varied drives, or recognition_threshold below 1"
            )
        return threshold

    def _different(self, one: _Sample, other: _Sample) -> bool:
        if one.drive != other.drive:
            return True
        return bool(np.linalg.norm(one.position - other.position) > self.apart)

    def _samples(self, encoder: Encoder, drives: Sequence[Sequence[Observation]]) -> Iterator[_Sample]:
        chosen = [(drive, index) for drive, frames in enumerate(drives) for index in range(len(frames))]
        kept = np.linspace(0, len(chosen) - 1, min(self.frames, len(chosen))).round().astype(int)
        for drive, index in (chosen[k] for k in kept):
            observation = drives[drive][index]
            if "gps" not in observation:
                raise DataError(f"recognition threshold: frame {index} of training drive {drive} has no gps")
            yield _Sample(drive, observation["gps"], encoder.encode(observation["frame"]).signatures)
