"""Place fields: how strongly each place answers along the very drive that it was learned on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from jaxtyping import Float32, Float64, Int64

from vprbench.env import RouteEnv
from vprbench.episode import Recording, calibrate, play
from vprbench.protocols import DescriptorLocalizer, Localizer
from vprbench.reporting import Report, silent
from vprbench.response_matrix import ResponseMatrix
from vprbench.route import Route

__all__ = ["PlaceFields", "record_fields"]


@dataclass(frozen=True)
class PlaceFields:
    """What every place answered to every frame of the learn drive in the record phase.

    Attributes:
        route: name of the route.
        agent: whose places they are.
        sampling_distance: metres between places, on average.
        distance: (frames,) road driven up to each frame, metres.
        frames: (frames,) each frame's number in its data set.
        places: (places,) the frame, counted along the drive, at which each place was made.
        winners: (frames,) the place that answered most, -1 for none: a place's field is where it wins.
        responses: (frames, places) 0..1.
    """

    route: str
    agent: str
    sampling_distance: float
    distance: Float64[np.ndarray, " frames"]
    frames: Int64[np.ndarray, " frames"]
    places: Int64[np.ndarray, " places"]
    winners: Int64[np.ndarray, " frames"]
    responses: Float32[np.ndarray, "frames places"]

    def table(self) -> pd.DataFrame:
        """One row for each place and frame."""
        count = len(self.distance)
        made, seen = np.repeat(self.places, count), np.tile(np.arange(count), len(self.places))
        place = np.repeat(np.arange(len(self.places)), count)
        return pd.DataFrame(
            {
                "route": self.route,
                "agent": self.agent,
                "place": place,
                "made_at_frame": self.frames[made],
                "made_at_m": self.distance[made],
                "frame": self.frames[seen],
                "distance_m": self.distance[seen],
                "response": self.responses.T.ravel(),
                "wins": self.winners[seen] == place,
            }
        )


def record_fields(
    route: Route, localizer: Localizer, sampling_distance: float, *, agent: str, report: Report = silent
) -> PlaceFields:
    """Let a fitted localizer learn the learn drive, and see what its places answer when that is driven again.

    Args:
        route: of which only the learn drive is played.
        localizer: fitted.
        sampling_distance: metres between places, on average.
        agent: what to call it.
        report: is told how far it has come.
    """
    # The record phase is the test phase of a route that is tested on what it learned.
    recording = _played(replace(route, test=route.learn, truth=None), localizer, sampling_distance, report)
    return PlaceFields(
        route.name,
        agent,
        sampling_distance,
        route.learn.distance,
        route.learn.indices,
        recording.place_frames,
        recording.winners,
        recording.responses,
    )


def _played(route: Route, localizer: Localizer, sampling_distance: float, report: Report) -> Recording:
    """The answers, by the way that is fastest for the localizer."""
    if isinstance(localizer, DescriptorLocalizer):
        matrix = ResponseMatrix(route, localizer, report)
        return matrix.recording(matrix.sampling(sampling_distance))
    calibrate(localizer, route, sampling_distance)
    return play(RouteEnv(route, sampling_distance), localizer)
