"""Max-Pi: places as constellations of landmarks, each a signature seen in a direction.

M. Espada et al., 2019 (LPMP), as the paper uses it: a unit's activity is the largest product of what (match) and
where (agreement of azimuths), and a place cell's response is the mean activity of its units.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite, radians
from typing import ClassVar, get_args

import numpy as np
from jaxtyping import Float32

from vprbench.errors import ConfigError
from vprbench.protocols import Encoder, Recruiting
from vprbench.types import Observation, Responses
from vprbench_localizers.azimuth import azimuths
from vprbench_localizers.calibration import Calibration
from vprbench_localizers.memory import memory_for
from vprbench_localizers.storage import Storage, can_store, in_bytes
from vprbench_localizers.unit_activity import Rule, View

__all__ = ["MaxPi"]

# Places compared at a time: bounds the memory that `compare` copies; the responses do not depend on it.
BLOCK = 64


class MaxPi:
    """A localizer whose places respond by their landmarks: how they look, and in which direction they stand.

    A place is recruited when no learned place responds as strongly as the vigilance; the first frame always
    recruits. A place responds 1 to the very frame that it was made of, and 0 to a frame without landmarks.

    Args:
        encoder: finds and compares the landmarks, fitted before; one that also has `match_pairs` is faster, and still
            faster are those that match by sketches or by the overlap of sparse codes: see
            `matching`.
        vigilance: until `clear` sets another, 0..1 (our choice).
        azimuth_width_deg: width of the Gaussian agreement of azimuths, degrees (our choice); None or inf: all
            azimuths agree, so the heading plays no part.
        azimuth_reach: azimuths further apart than so many widths do not agree at all (our choice: 3 widths, where
            the Gaussian is 0.011), so their landmarks need not be compared.
        recognition_threshold: match below which two landmarks have nothing in common; None: calibrated by `fit`.
        recognition_percentile: of the matches between training places that `fit` takes (our choice).
        different_places: two training frames of one drive further apart than this differ, metres (our choice).
        calibration_frames: at most so many training frames are compared (our choice).
        storage: of signatures, those of places and of queries alike: "float32", or "uint8", which rounds each value
            to a 255th and takes a quarter of the memory; for encoders that have `matches_bytes`. A response
            then differs by at most 1 / 255 / (1 - recognition threshold); see docs/performance.md.

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
        storage: Storage = "float32",
    ) -> None:
        width = inf if azimuth_width_deg is None else azimuth_width_deg
        _require(isinstance(encoder, Encoder), "encoder must have fit, encode and match", encoder)
        _require(width > 0, "azimuth_width_deg must be above 0", width)
        _require(azimuth_reach > 0, "azimuth_reach must be above 0", azimuth_reach)
        given = recognition_threshold
        _require(given is None or 0 <= given < 1, "recognition_threshold must be at least 0 and below 1", given)
        _require(storage in get_args(Storage), f"storage must be one of {', '.join(get_args(Storage))}", storage)
        asked = "storage must be 'float32' with an encoder that does not match bytes (log-polar does)"
        _require(can_store(storage, encoder), asked, storage)
        self.encoder, self.storage = encoder, storage
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
        self._memory = memory_for(self.encoder)

    def learn(self, observation: Observation) -> int | None:
        """Make this observation a place if no place responds to it as strongly as the vigilance."""
        view = self.describe(observation)
        responses = self.answer(view)
        if len(responses) and np.fmax.reduce(responses) >= np.float32(self.vigilance):
            return None
        return self.store(view)

    def store(self, view: View) -> int:
        """Make a place of this description, whatever responds to it; its index."""
        return self._memory.add(view)

    def respond(self, observation: Observation) -> Responses:
        """Response 0..1 of every learned place."""
        return self.answer(self.describe(observation))

    def answer(self, query: View) -> Responses:
        """Response of every learned place to a description."""
        return self._memory.respond(query, self.rule)

    def describe(self, observation: Observation) -> View:
        """The signatures and azimuths of one observation's landmarks."""
        landmarks = self.encoder.encode(observation["frame"])
        columns, camera = landmarks.points[:, 0], observation["camera"]
        signatures = in_bytes(landmarks.signatures) if self.storage == "uint8" else landmarks.signatures
        return View(signatures, azimuths(columns, self._heading(observation), camera))

    def compare(self, queries: Sequence[View], places: Sequence[View]) -> Float32[np.ndarray, "queries places"]:
        """Response of a place stored as each of `places` to each of `queries`: bitwise what `respond` gives."""
        responses = np.zeros((len(queries), len(places)), np.float32)
        for first in range(0, len(places), BLOCK):
            memory = memory_for(self.encoder)
            for place in places[first : first + BLOCK]:
                memory.add(place)
            for query, row in zip(queries, responses, strict=True):
                row[first : first + BLOCK] = memory.respond(query, self.rule)
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

    @property
    def rule(self) -> Rule:
        """What makes a unit active.

        Raises:
            ConfigError: there is no recognition threshold yet.
        """
        if self.recognition_threshold is None:
            raise ConfigError("max-pi: no recognition threshold: call fit(drives), or give recognition_threshold")
        return Rule(self.recognition_threshold, self._width, self._reach)


def _require(valid: bool, rule: str, value: object) -> None:
    if not valid:
        raise ConfigError(f"max-pi: {rule}, not {value!r}")
