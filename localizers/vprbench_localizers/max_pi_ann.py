"""Max-Pi for large maps: only places that have a landmark much like one of the query's are asked.

Needs faiss: `pip install 'vprbench[ann]'`.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, pi
from typing import ClassVar

import numpy as np

from vprbench.errors import ConfigError, DataError
from vprbench.geodesy import wrap
from vprbench.protocols import Encoder, Recruiting
from vprbench.types import Observation, Responses
from vprbench_localizers.landmark_index import LandmarkIndex, landmark_vectors, require_faiss
from vprbench_localizers.max_pi import MaxPi
from vprbench_localizers.sparse_views import SparseViews
from vprbench_localizers.unit_activity import View

__all__ = ["MaxPiAnn"]

# At most so many training frames give samples for the index, evenly spaced (our choice).
SAMPLE_FRAMES = 400

# By which the azimuths of those frames are turned, radians (our choice).
TURNS = (0.0, pi / 2, pi, -pi / 2)


class MaxPiAnn:
    """A localizer whose places respond exactly as Max-Pi's if they are reached, and 0 if not.

    A place is reached if one of its landmarks is among the stored ones most like one of the query's, in look and in
    direction. Learning, too, goes by the responses of places reached.

    Args:
        encoder: see `MaxPi`.
        vigilance: see `MaxPi`.
        azimuth_width_deg: see `MaxPi`.
        azimuth_reach: see `MaxPi`.
        recognition_threshold: see `MaxPi`.
        neighbours: so many stored landmarks are reached from each of the query's (our choice).
        lists: into which the index sorts landmarks; more are quicker to search and slower to learn (our choice).
        probes: so many of the lists are searched for each landmark (our choice).

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
        neighbours: int = 30,
        lists: int = 1024,
        probes: int = 4,
    ) -> None:
        for name, value in (("neighbours", neighbours), ("lists", lists), ("probes", probes)):
            if value < 1:
                raise ConfigError(f"max-pi-ann: {name} must be 1 or more, not {value!r}")
        require_faiss()
        self.encoder = encoder
        self.neighbours, self.lists, self.probes = neighbours, lists, probes
        self._exact = MaxPi(
            encoder,
            azimuth_width_deg=azimuth_width_deg,
            azimuth_reach=azimuth_reach,
            recognition_threshold=recognition_threshold,
        )
        # Where all azimuths agree they must not part landmarks in the index either.
        self._azimuth_weight = 1.0 if azimuth_width_deg is not None and isfinite(azimuth_width_deg) else 0.0
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
        # A training drive goes in few directions, a large map in all.
        turned = [_turned(view, turn) for view in views for turn in TURNS]
        samples = [landmark_vectors(view, self._azimuth_weight) for view in turned if len(view.azimuths)]
        if not samples:
            raise DataError("max-pi-ann: the training drives show no landmark to set up the index by; give others")
        self._index = LandmarkIndex(np.concatenate(samples), self.lists, self.probes)
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
            index.add(landmark_vectors(view, self._azimuth_weight))
        return place

    def answer(self, query: View) -> Responses:
        """Response of every place to a view."""
        index = self._fitted()
        responses = np.zeros(len(self._views), np.float32)
        if self._views.units and len(query.azimuths):
            units = index.nearest(landmark_vectors(query, self._azimuth_weight), self.neighbours)
            reached = np.unique(self._views.places_of(units))
            responses[reached] = self._exact.compare([query], [self._views[place] for place in reached])[0]
        return responses

    def _fitted(self) -> LandmarkIndex:
        if self._index is None:
            raise ConfigError("max-pi-ann: the index is not set up: call fit(drives)")
        return self._index


def _turned(view: View, turn: float) -> View:
    """The same landmarks, as if the camera had been headed otherwise by `turn` radians."""
    return View(view.signatures, wrap(view.azimuths.astype(np.float64) + turn).astype(np.float32))
