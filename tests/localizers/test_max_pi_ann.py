from __future__ import annotations

from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from vprbench.agents import build, build_encoder
from vprbench.checks import Check, parametrize_with_checks
from vprbench.checks.samples import drive, flat_frame, training_drives
from vprbench.errors import ConfigError, DataError
from vprbench.observation import Drive
from vprbench.protocols import DescriptorLocalizer, Encoder
from vprbench.route import Route
from vprbench.types import Observation
from vprbench_encoders.log_polar import log_polar_6
from vprbench_localizers import landmark_index
from vprbench_localizers.max_pi import MaxPi
from vprbench_localizers.max_pi_ann import MaxPiAnn


def few() -> MaxPiAnn:
    return MaxPiAnn(log_polar_6(), looks=8)


@parametrize_with_checks(localizer=few)
def test_max_pi_ann_conforms(check: Check) -> None:
    check.run()


@pytest.fixture(scope="module", params=["log-polar-6", "hsd-12"])
def encoder(request: pytest.FixtureRequest, toy_route: Route) -> Encoder:
    """Fitted to a few frames, in a hurry where it learns."""
    hurried = {"steps": 5, "epochs": 1} if request.param == "hsd-12" else {}
    encoder = build_encoder({"name": request.param, **hurried})
    encoder.fit([seen["frame"] for drive in toy_route.training for seen in Drive(drive)])
    return encoder


def learned(localizer: MaxPi | MaxPiAnn, route: Route) -> MaxPi | MaxPiAnn:
    """Fitted, and with a place of every third frame."""
    localizer.fit([Drive(traverse) for traverse in route.training])
    localizer.clear(1.0)
    for observation in Drive(route.learn)[::3]:
        localizer.learn(observation)
    return localizer


@pytest.mark.parametrize("width", [5.0, None])
def test_where_every_landmark_is_reached_it_is_max_pi_bit_by_bit(
    encoder: Encoder, toy_route: Route, width: float | None
) -> None:
    # Azimuths of one width apart are looked for: that far they may agree.
    shared: dict[str, Any] = {"azimuth_width_deg": width, "azimuth_reach": 1.0}
    exact = learned(MaxPi(encoder, **shared), toy_route)
    everywhere = learned(MaxPiAnn(encoder, **shared, looks=4, probes=4, likeness=-9.0), toy_route)
    for query in Drive(toy_route.test, gps=False)[::8]:
        np.testing.assert_array_equal(everywhere.respond(query), exact.respond(query))


def test_a_place_responds_as_in_max_pi_or_not_at_all(encoder: Encoder, toy_route: Route) -> None:
    exact = learned(MaxPi(encoder), toy_route)
    nearest = learned(MaxPiAnn(encoder, candidates=4, looks=8, probes=2), toy_route)
    silent = 0
    for query in Drive(toy_route.test, gps=False)[::5]:
        asked, told = exact.respond(query), nearest.respond(query)
        np.testing.assert_array_equal(told[told > 0], asked[told > 0])
        assert 0 < np.count_nonzero(told) <= 4
        silent += int(np.count_nonzero((told == 0) & (asked > 0)))
    assert silent > 0


def test_it_is_built_from_its_name_and_offers_no_matrix_of_responses() -> None:
    localizer = build({"localizer": "max-pi-ann", "encoder": "log-polar-6", "candidates": 5})
    assert isinstance(localizer, MaxPiAnn)
    # A response depends on which other places are nearer.
    assert not isinstance(localizer, DescriptorLocalizer)


def test_a_copy_learns_for_itself() -> None:
    original = few()
    original.fit(training_drives())
    first, second = drive(2)
    original.clear(1.0)
    original.learn(first)
    copied = deepcopy(original)
    copied.learn(second)
    assert (len(original.respond(first)), len(copied.respond(first))) == (1, 2)
    assert copied.respond(second)[1] == pytest.approx(1.0)


def test_it_must_be_fitted_even_where_the_threshold_is_given() -> None:
    localizer, (seen,) = MaxPiAnn(log_polar_6(), recognition_threshold=0.5), drive(1)
    for ask in (localizer.learn, localizer.respond):
        with pytest.raises(ConfigError, match=r"call fit\(drives\)"):
            ask(seen)


def test_training_drives_without_landmarks_are_refused() -> None:
    blank = [Observation(**{**seen, "frame": flat_frame(9)}) for seen in drive(3)]
    with pytest.raises(DataError, match="no landmark"):
        MaxPiAnn(log_polar_6(), recognition_threshold=0.5).fit([blank])


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"likeness": 1.5}, "likeness must be at most 1"),
        ({"candidates": 0}, "candidates must be 1 or more"),
        ({"looks": 0}, "looks must be 1 or more"),
        ({"probes": -1}, "probes must be 1 or more"),
        ({"vigilance": 2.0}, "vigilance must be"),
        ({"azimuth_width_deg": -1.0}, "azimuth_width_deg must be"),
    ],
)
def test_an_option_out_of_range_is_refused(options: dict[str, Any], text: str) -> None:
    with pytest.raises(ConfigError, match=text):
        MaxPiAnn(log_polar_6(), **options)


def test_without_faiss_none_is_built(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(landmark_index, "find_spec", lambda name: None)
    with pytest.raises(ConfigError, match=r"pip install 'vprbench\[ann\]'$"):
        build({"localizer": "max-pi-ann", "encoder": "log-polar-6"})
