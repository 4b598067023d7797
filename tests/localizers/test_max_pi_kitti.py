from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from vprbench.catalogue import load_route
from vprbench.observation import Drive
from vprbench_encoders.log_polar import LogPolar
from vprbench_localizers.max_pi import MaxPi


@pytest.mark.kitti
def test_real_places_are_recognised_on_a_revisit(kitti_root: Path) -> None:
    route = load_route("KITTI-K0-2", kitti_root)
    agent = MaxPi(LogPolar(), vigilance=1.0, calibration_frames=20)
    agent.fit([Drive(drive) for drive in route.training])
    places, queries = range(0, len(route.learn), 6), range(4, len(route.test), 8)
    for frame in places:
        agent.learn(Drive(route.learn)[frame])
    winners = [places[int(agent.respond(Drive(route.test, gps=False)[frame]).argmax())] for frame in queries]
    error = np.linalg.norm(route.learn.positions[winners] - route.test.positions[queries], axis=1)
    # Places lie about 4 m apart, test frames up to 2 m from the learn drive.
    assert np.mean(error < 6.0) >= 0.8
