"""Max-Pi: places as constellations of landmarks, each a signature seen in a direction.

M. Espada et al., 2019 (LPMP), as the paper uses it: a unit's activity is the largest product of what (match) and
where (agreement of azimuths), and a place cell's response is the mean activity of its units.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite, radians
from typing import ClassVar

import numpy as np
from jaxtyping import Float32
from numba import njit
from numpy.typing import NDArray

from vprbench.errors import ConfigError
from vprbench.protocols import Encoder, Recruiting
from vprbench.types import Observation, Responses
from vprbench_localizers.azimuth import agreeing_pairs, agreement, azimuths
from vprbench_localizers.calibration import Calibration
from vprbench_localizers.matching import pair_matcher
from vprbench_localizers.unit_memory import UnitMemory, View

__all__ = ["MaxPi"]

# Places compared at a time: bounds the memory that `compare` copies; the responses do not depend on it.
BLOCK = 64

# Places whose pairs are listed at a time: few enough that the lists stay in the cache.
TOGETHER = 16


@njit(cache=True)
def _place_responses(
    pairs: tuple[NDArray[np.int64], NDArray[np.int64]],
    matches: NDArray[np.float32],
    queries: NDArray[np.float32],
    units: NDArray[np.float32],
    starts: NDArray[np.int64],
    width: float,
    threshold: float,
) -> NDArray[np.float32]:
    """Mean over each place's units of max over pairs of min(1, max(0, s - RT) / (1 - RT)) * agreement of azimuths."""
    activity = np.zeros(len(units), np.float32)
    scale = np.float32(1) - np.float32(threshold)
    for pair in range(len(matches)):
        recognised = (matches[pair] - np.float32(threshold)) / scale
        if recognised > 0:
            p, m = pairs[0][pair], pairs[1][pair]
            product = min(recognised, np.float32(1)) * agreement(queries[p], units[m], width)
            activity[m] = max(activity[m], product)
    responses = np.zeros(len(starts) - 1, np.float32)
    for place in range(len(responses)):
        first, end = starts[place], starts[place + 1]
        for unit in range(first, end):
            responses[place] += activity[unit]
        if end > first:
            responses[place] /= np.float32(end - first)
    return responses


class MaxPi:
    """A localizer whose places respond by their landmarks: how they look, and in which direction they stand.

    A place is recruited when no learned place responds as strongly as the vigilance; the first frame always
    recruits. A place responds 1 to the very frame that it was made of, and 0 to a frame without landmarks.

    Args:
        encoder: finds and compares the landmarks, fitted before; one that also has `match_pairs` (see `PairEncoder`)
            is faster.
        vigilance: until `clear` sets another, 0..1 (our choice).
        azimuth_width_deg: width of the Gaussian agreement of azimuths, degrees (our choice); None or inf: all
            azimuths agree, so the heading plays no part.
        azimuth_reach: azimuths further apart than so many widths do not agree at all (our choice: 3 widths, where
            the Gaussian is 0.011), so their landmarks need not be compared.
        recognition_threshold: match below which two landmarks have nothing in common; None: calibrated by `fit`.
        recognition_percentile: of the matches between training places that `fit` takes (our choice).
        different_places: two training frames of one drive further apart than this differ, metres (our choice).
        calibration_frames: at most so many training frames are compared (our choice).

    Raises:
        ConfigError: an option is out of its range; or a frame without a heading, unless all azimuths agree.
    """

    recruiting: ClassVar[Recruiting] = "vigilance"

    def __init__(
        self,
        encoder: Encoder,
        *,
        vigilance: float = 0.5,
        azimuth_width_deg: float | None = 5.0,
        azimuth_reach: float = 3.0,
        recognition_threshold: float | None = None,
        recognition_percentile: float = 90.0,
        different_places: float = 25.0,
        calibration_frames: int = 60,
    ) -> None:
        width = inf if azimuth_width_deg is None else azimuth_width_deg
        _require(isinstance(encoder, Encoder), "encoder must have fit, encode and match", encoder)
        _require(width > 0, "azimuth_width_deg must be above 0", width)
        _require(azimuth_reach > 0, "azimuth_reach must be above 0", azimuth_reach)
        given = recognition_threshold
        _require(given is None or 0 <= given < 1, "recognition_threshold must be at least 0 and below 1", given)
        self.encoder = encoder
        self.recognition_threshold = recognition_threshold
        self._calibration = Calibration(recognition_percentile, different_places, calibration_frames)
        self._calibrate = given is None
        self._width = radians(width)
        self._reach = self._width * azimuth_reach
        self.clear(vigilance)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Calibrate the recognition threshold through the fitted encoder, if none was given; forget places."""
        if self._calibrate:
            self.recognition_threshold = self._calibration.threshold(self.encoder, drives)
        self.clear(self.vigilance)

    def clear(self, sampling: float) -> None:
        """Forget every place, and recruit from now on at this vigilance (0..1)."""
        _require(0 <= sampling <= 1, "vigilance must be 0..1", sampling)
        self.vigilance = sampling
        self._memory = UnitMemory()

    def learn(self, observation: Observation) -> int | None:
        """Make this observation a place if no place responds to it as strongly as the vigilance."""
        view = self.describe(observation)
        responses = self._respond(view, self._memory)
        if len(responses) and np.fmax.reduce(responses) >= np.float32(self.vigilance):
            return None
        return self._memory.add(view)

    def respond(self, observation: Observation) -> Responses:
        """Response 0..1 of every learned place."""
        return self._respond(self.describe(observation), self._memory)

    def describe(self, observation: Observation) -> View:
        """The signatures and azimuths of one observation's landmarks."""
        landmarks = self.encoder.encode(observation["frame"])
        columns, camera = landmarks.points[:, 0], observation["camera"]
        return View(landmarks.signatures, azimuths(columns, self._heading(observation), camera))

    def compare(self, queries: Sequence[View], places: Sequence[View]) -> Float32[np.ndarray, "queries places"]:
        """Response of a place stored as each of `places` to each of `queries`: bitwise what `respond` gives."""
        responses = np.zeros((len(queries), len(places)), np.float32)
        for first in range(0, len(places), BLOCK):
            memory = UnitMemory.of(places[first : first + BLOCK])
            for query, row in zip(queries, responses, strict=True):
                row[first : first + BLOCK] = self._respond(query, memory)
        return responses

    def _heading(self, observation: Observation) -> float:
        """The camera's heading, radians; where none is sensed, any one will do if all azimuths agree."""
        if "heading" in observation:
            return float(observation["heading"][0])
        if isfinite(self._width):
            raise ConfigError(
                "max-pi: the route has no headings, which azimuths need: set azimuth_width_deg = inf to match "
                "landmarks without them"
            )
        return 0.0

    def _respond(self, query: View, memory: UnitMemory) -> Responses:
        if self.recognition_threshold is None:
            raise ConfigError("max-pi: no recognition threshold: call fit(drives), or give recognition_threshold")
        if not (memory.units and len(query.azimuths)):
            return np.zeros(len(memory), np.float32)
        matcher = pair_matcher(self.encoder, self.recognition_threshold)
        responses = np.empty(len(memory), np.float32)
        for first, units in zip(range(0, len(memory), TOGETHER), memory.blocks(TOGETHER), strict=True):
            pairs = agreeing_pairs(query.azimuths, units.azimuths, self._reach)
            matches = matcher(query.signatures, units, *pairs)
            responses[first : first + TOGETHER] = _place_responses(
                pairs, matches, query.azimuths, units.azimuths, units.starts, self._width, self.recognition_threshold
            )
        return responses


def _require(valid: bool, rule: str, value: object) -> None:
    if not valid:
        raise ConfigError(f"max-pi: {rule}, not {value!r}")
