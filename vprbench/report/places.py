"""Where each answered place was learned, read back from a trace."""

from __future__ import annotations

import numpy as np

from vprbench.route import Route
from vprbench.trace import Trace
from vprbench.types import NO_PLACE

__all__ = ["place_frames"]

# Metres. A trace keeps every error to the last bit; the rounding of another machine is far below this.
_SAME = 1e-6


def place_frames(trace: Trace, route: Route) -> dict[int, int]:
    """The learn frame of each place that was ever answered, as far as the errors tell it.

    A place was learned at the one frame that lies `error_m` away from every query answered with it. A place that
    several frames could be, on a road symmetrical about all of its queries, is left out.
    """
    fits = np.abs(route.visit.gaps - trace.error_m[:, None]) < _SAME
    found = {}
    for place in np.unique(trace.hypothesis[trace.hypothesis != NO_PLACE]):
        candidates = np.flatnonzero(fits[trace.hypothesis == place].all(axis=0))
        if len(candidates) == 1:
            found[int(place)] = int(candidates[0])
    return found
