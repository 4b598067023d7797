"""A straight street under a high sun, with nothing in it, and a plain white texture."""

from __future__ import annotations

import numpy as np
import pytest

from vprbench.street.course import BEHIND, SPACING, Course
from vprbench.street.sunlight import Outline, Sunlight, shade_stations, sun_over
from vprbench.street.texture import Skins, stack_skins


@pytest.fixture(scope="session")
def straight() -> Course:
    """Due north along the origin's meridian for 200 m."""
    stations = np.arange(round((200.0 + BEHIND) / SPACING)) * SPACING - BEHIND
    zero = np.zeros_like(stations)
    return Course(np.stack([zero, stations], axis=1), zero, zero)


@pytest.fixture(scope="session")
def open_sky(straight: Course) -> Sunlight:
    """The sun in the zenith, and nothing that casts a shadow."""
    far = np.full((2, len(shade_stations(straight))), 1e3)
    outline = Outline(wall=far, crown=far, height=0 * far, low=0 * far + 1, high=0 * far)
    return sun_over(straight, outline, azimuth=0.0, elevation=np.pi / 2, leaves=np.zeros((64, 64)))


@pytest.fixture(scope="session")
def white() -> Skins:
    """One texture, white and opaque."""
    return stack_skins([np.ones((16, 16, 2), np.float32)])
