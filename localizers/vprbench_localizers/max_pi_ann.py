"""Max-Pi for large maps: only places that have landmarks much like the query's are asked.

Needs faiss: `pip install 'vprbench[ann]'`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from jaxtyping import Int64

from vprbench.errors import ConfigError, DataError
from vprbench.protocols import Encoder, Recruiting
from vprbench.types import Observation, Responses
from vprbench_localizers.landmark_index import LandmarkIndex, require_faiss
from vprbench_localizers.matching import OverlapEncoder
from vprbench_localizers.max_pi import MaxPi
from vprbench_localizers.overlap_response import overlap_responses
from vprbench_localizers.sparse_views import SparseViews
from vprbench_localizers.unit_activity import View

__all__ = ["MaxPiAnn"]

# At most so many training frames give samples for the index, evenly spaced (our choice).
SAMPLE_FRAMES = 400

# Azimuths of so many widths apart are looked for (our choice: there the Gaussian is 0.6).
SPAN = 1.0


class MaxPiAnn:
    """A localizer whose places respond exactly as Max-Pi's if they are reached, and 0 if not.

    Places are reached whose landmarks are together most like the query's, in look and in direction. Learning, too, goes
    by the responses of places reached.

    Args:
        encoder: see `MaxPi`.
        vigilance: see `MaxPi`.
        azimuth_width_deg: see `MaxPi`.
        azimuth_reach: see `MaxPi`.
        recognition_threshold: see `MaxPi`.
        candidates: at most so many places are reached (our choice).
        looks: by which the index sorts landmarks; more are quicker to search and slower to learn (our choice).
        probes: so many of the looks are searched for each landmark (our choice).
        likeness: landmarks less alike do not count, 1: only equal ones (our choice).

    Raises:
        ConfigError: an option is out of its range, or faiss is not installed.
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
        candidates: int = 10_000,
        looks: int = 256,
        probes: int = 8,
        likeness: float = 0.3,
    ) -> None:
        counts = {"candidates": candidates, "looks": looks, "probes": probes}
        for name, value in counts.items():
            if value < 1:
                raise ConfigError(f"max-pi-ann: {name} must be 1 or more, not {value!r}")
        if not likeness <= 1:
            raise ConfigError(f"max-pi-ann: likeness must be at most 1, not {likeness!r}")
        require_faiss()
        self.encoder = encoder
        self.candidates, self.looks, self.probes, self.likeness = candidates, looks, probes, likeness
        self._exact = MaxPi(
            encoder,
            azimuth_width_deg=azimuth_width_deg,
            azimuth_reach=azimuth_reach,
            recognition_threshold=recognition_threshold,
        )
        self._index: LandmarkIndex | None = None
        self.clear(vigilance)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Calibrate as `MaxPi` does, and set up the lists of the index by landmarks of these drives; forget places.

        Raises:
            DataError: the drives show no landmark.
        """
        self._exact.fit(drives)
        chosen = [(drive, index) for drive in drives for index in range(len(drive))]
        kept = np.linspace(0, len(chosen) - 1, min(SAMPLE_FRAMES, len(chosen))).round().astype(int)
        views = [self.describe(chosen[k][0][chosen[k][1]]) for k in kept]
        samples = [view.signatures for view in views if len(view.azimuths)]
        if not samples:
            raise DataError("max-pi-ann: the training drives show no landmark to set up the index by; give others")
        self._index = LandmarkIndex(
            np.concatenate(samples),
            looks=self.looks,
            probes=self.probes,
            likeness=self.likeness,
            span=SPAN * self._exact.rule.width,
        )
        self.clear(self.vigilance)

    def clear(self, sampling: float) -> None:
        """Forget every place, and recruit from now on at this vigilance (0..1)."""
        self._exact.clear(sampling)
        self.vigilance = sampling
        self._views = SparseViews()
        if self._index is not None:
            self._index.clear()

    def learn(self, observation: Observation) -> int | None:
        """Make this observation a place if no place reached responds to it as strongly as the vigilance."""
        view = self.describe(observation)
        responses = self.answer(view)
        if len(responses) and responses.max() >= np.float32(self.vigilance):
            return None
        return self.store(view)

    def respond(self, observation: Observation) -> Responses:
        """Response 0..1 of every learned place."""
        return self.answer(self.describe(observation))

    def describe(self, observation: Observation) -> View:
        """The signatures and azimuths of one observation's landmarks."""
        return self._exact.describe(observation)

    def store(self, view: View) -> int:
        """Make a view a place, whatever responds to it; the place's index."""
        index = self._fitted()
        place = self._views.add(view)
        if len(view.azimuths):
            index.add(view, place)
        return place

    def answer(self, query: View) -> Responses:
        """Response of every place to a view."""
        index = self._fitted()
        responses = np.zeros(len(self._views), np.float32)
        if len(query.azimuths) and len(self._views):
            self._views.require(query.signatures.shape[1])
            reached = index.places_like(query, self.candidates)
            responses[reached] = self._ask(query, reached)
        return responses

    def _ask(self, query: View, places: Int64[np.ndarray, " reached"]) -> Responses:
        """Response of these places, as Max-Pi's."""
        if isinstance(self.encoder, OverlapEncoder) and self.encoder.matches_by_overlap:
            return overlap_responses(query, self._views.units, places, self._exact.rule)
        return self._exact.compare([query], [self._views[place] for place in places])[0]

    def _fitted(self) -> LandmarkIndex:
        if self._index is None:
            raise ConfigError("max-pi-ann: the index is not set up: call fit(drives)")
        return self._index
