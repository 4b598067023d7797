"""What Max-Pi is made of: its options, refused by name where they cannot work, and what a configuration makes."""

from __future__ import annotations

import pytest

from vprbench.agents import build
from vprbench.errors import ConfigError
from vprbench.protocols import DescriptorLocalizer
from vprbench_encoders.log_polar import LogPolar
from vprbench_localizers.matching import SketchingEncoder
from vprbench_localizers.max_pi import MaxPi


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"vigilance": 1.5}, "vigilance"),
        ({"vigilance": float("nan")}, "vigilance"),
        ({"azimuth_width_deg": 0.0}, "azimuth_width_deg"),
        ({"azimuth_reach": -1.0}, "azimuth_reach"),
        ({"recognition_threshold": 1.0}, "recognition_threshold"),
        ({"recognition_percentile": 101.0}, "percentile"),
        ({"different_places": -1.0}, "apart"),
        ({"calibration_frames": 1}, "frames"),
    ],
)
def test_impossible_options_are_refused_by_name(options: dict[str, float], named: str) -> None:
    with pytest.raises(ConfigError, match=named):
        MaxPi(LogPolar(), **options)  # type: ignore[arg-type]


def test_what_is_no_encoder_is_refused() -> None:
    with pytest.raises(ConfigError, match="encoder must have fit, encode and match"):
        MaxPi("log-polar")  # type: ignore[arg-type]


def test_configurations_build_it_and_it_keeps_its_protocols() -> None:
    agent = build({"localizer": "max-pi", "encoder": {"name": "log-polar-12", "points": 15}, "vigilance": 0.3})
    assert isinstance(agent, MaxPi)
    assert isinstance(agent, DescriptorLocalizer)
    assert isinstance(agent.encoder, SketchingEncoder)
    assert agent.vigilance == 0.3
