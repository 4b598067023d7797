"""CoHOG: places as grids of oriented-gradient histograms, matched region by region wherever the query is busy.

M. Zaffar et al., "CoHOG", IEEE RA-L 2020, as the authors' public Python implementation computes it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import ClassVar, get_args

import cv2
import numpy as np
from jaxtyping import Float32

from vprbench.errors import ConfigError, DataError, nearest
from vprbench.protocols import Recruiting
from vprbench.recruiting import Odometer
from vprbench.types import NO_PLACE, Hypothesis, Observation, Responses
from vprbench_localizers.entropy import SIDE, region_entropy
from vprbench_localizers.hog import Magnitude, cell_histograms
from vprbench_localizers.place_memory import PlaceMemory
from vprbench_localizers.place_search import Found, best_place
from vprbench_localizers.region_match import Description, describe_regions, score_places

__all__ = ["CoHOG"]


class CoHOG:
    """A localizer that needs no training: places respond by how well the query's busy regions are found in them.

    The response is the mean over the query's kept regions of the best cosine with any region of the place, in
    0..1; a query of which no region is kept responds 0. A frame is recruited each time the distance travelled
    since the last place reaches the step; the first frame always is.

    Args:
        step: until `clear` sets another, metres; 0 makes every frame a place (our choice: the paper's middle
            sampling distance).
        entropy_threshold: regions of the query with less entropy than this, 0..1, are left out (0.4 in VPR-Bench;
            the authors' own repository has 0.5).
        magnitude: strength of a gradient, "mean" = |gx + gy| / 2 as the public implementation has it, or "hypot"
            = its length.
        threads: at most so many share the places of a query between them; the responses do not depend on it. A
            sweep already runs one worker a core: leave it at 1 there (our choice: as everywhere else).

    Raises:
        ConfigError: an option is out of its range.
    """

    recruiting: ClassVar[Recruiting] = "step"

    def __init__(
        self, step: float = 3.0, entropy_threshold: float = 0.4, magnitude: Magnitude = "mean", threads: int = 1
    ) -> None:
        if not 0 <= entropy_threshold <= 1:
            raise ConfigError(f"cohog: entropy_threshold must be 0..1, not {entropy_threshold!r}")
        if magnitude not in get_args(Magnitude):
            raise ConfigError(f"cohog: no magnitude {magnitude!r}: {nearest(magnitude, get_args(Magnitude))}")
        if threads < 1:
            raise ConfigError(f"cohog: threads must be 1 or more, not {threads!r}")
        self.entropy_threshold = entropy_threshold
        self.magnitude = magnitude
        self.threads = threads
        self.clear(step)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        """Do nothing: CoHOG does not train."""

    def clear(self, sampling: float) -> None:
        """Forget every place, and recruit from now on at this step (metres)."""
        if not (isfinite(sampling) and sampling >= 0):
            raise ConfigError(f"cohog: step must be 0 metres or more, not {sampling!r}")
        self._odometer = Odometer(sampling)
        self._memory = PlaceMemory()

    def learn(self, observation: Observation) -> int | None:
        """Make this observation a place if the step has been driven since the last one.

        Raises:
            DataError: the observation has no `gps`, so that the distance travelled is unknown.
        """
        if "gps" not in observation:
            raise DataError("cohog: learning goes by distance travelled: give every observation its `gps`")
        if not self._odometer.due(observation["gps"]):
            return None
        return self._memory.add(self.describe(observation).planes)

    def respond(self, observation: Observation) -> Responses:
        """Response 0..1 of every learned place."""
        responses = np.empty(len(self._memory), np.float32)
        score_places(self.describe(observation), self._memory.planes, responses, self.threads)
        return responses

    def locate(self, observation: Observation) -> Hypothesis:
        """The place that responds most, and its response: what `respond` would say, found without matching all."""
        found = self.search(self.describe(observation))
        return Hypothesis(found.place, found.response) if found.response > 0 else Hypothesis(NO_PLACE, 0.0)

    def search(self, query: Description) -> Found:
        """What `locate` finds, and how much of the map was matched for it."""
        return best_place(query, self._memory.planes, self._memory.outlines, self.threads)

    def describe(self, observation: Observation) -> Description:
        """The oriented gradients of one observation's regions, and which of them to ask for.

        Raises:
            DataError: the frame is not a grey uint8 image.
        """
        frame = observation["frame"]
        if frame.ndim != 2 or frame.dtype != np.uint8:
            raise DataError(f"cohog: a frame is grey uint8 (height, width), not {frame.dtype} {frame.shape}")
        image = cv2.resize(frame, (SIDE, SIDE), interpolation=cv2.INTER_LINEAR)
        kept = region_entropy(image) >= self.entropy_threshold
        return describe_regions(cell_histograms(image, self.magnitude), kept)

    def compare(
        self, queries: Sequence[Description], places: Sequence[Description]
    ) -> Float32[np.ndarray, "queries places"]:
        """Response of a place stored as each of `places` to each of `queries`: bitwise what `respond` gives."""
        responses = np.empty((len(queries), len(places)), np.float32)
        if places:
            memory = PlaceMemory.of(place.planes for place in places)
            for query, row in zip(queries, responses, strict=True):
                score_places(query, memory.planes, row, self.threads)
        return responses
