"""Signatures kept as one byte a value: what is lost, what is not, and what is refused."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from vprbench.agents import build
from vprbench.errors import ConfigError, PluginError
from vprbench.scale.held import held_bytes
from vprbench.types import Frame, Landmarks, Observation
from vprbench_encoders.log_polar import LogPolar
from vprbench_localizers.max_pi import MaxPi
from vprbench_localizers.memory import memory_for
from vprbench_localizers.storage import Storage, in_bytes
from vprbench_localizers.unit_activity import View

CAMERA = np.array([372.0, 314.0])

# What float32 may do to a response, whichever way it is computed.
ROUNDING = 1e-5


class Drawn(LogPolar):
    """Log-polar maps that are drawn by chance for each frame, smooth enough that many have much in common."""

    def __init__(self, seed: int, size: int = 54) -> None:
        super().__init__(size=size)
        self.seed = seed

    def encode(self, frame: Frame) -> Landmarks:
        rng = np.random.default_rng([self.seed, int(frame[0, 0])])
        signatures = rng.random((8, 1)) * 0.8 + rng.random((8, self.size**2)) * 0.2
        return Landmarks(signatures.astype(np.float32), (rng.random((8, 2)) * [642, 188]).astype(np.float32))


def observe(number: int) -> Observation:
    return Observation(frame=np.full((188, 642), number, np.uint8), heading=np.array([pi * number / 40]), camera=CAMERA)


def agents(seed: int, size: int, threshold: float) -> tuple[MaxPi, MaxPi]:
    """The same agent with signatures as they are, and as bytes."""
    encoder = Drawn(seed, size)
    plain = MaxPi(encoder, recognition_threshold=threshold, azimuth_width_deg=30.0, vigilance=1.0)
    return plain, MaxPi(
        encoder, recognition_threshold=threshold, azimuth_width_deg=30.0, vigilance=1.0, storage="uint8"
    )


@given(arrays(np.float32, (2, 5), elements=st.floats(0, 1, width=32)))
def test_no_value_is_off_by_more_than_half_a_step(values: NDArray[np.float32]) -> None:
    assert np.abs(in_bytes(values) / 255 - values).max() <= 1 / 510 + 1e-7


def test_steps_are_255ths_of_one() -> None:
    steps = np.arange(256)
    for shift in (-0.49, 0.0, 0.49):
        values = ((steps + shift) / 255).clip(0, 1).astype(np.float32)
        np.testing.assert_array_equal(in_bytes(values[None])[0], steps)
    assert in_bytes(np.empty((0, 7), np.float32)).shape == (0, 7)
    assert in_bytes(np.nextafter(np.ones((1, 1), np.float32), np.float32(2))) == 255


@pytest.mark.parametrize("value", [-0.01, 1.01, np.nan, np.inf])
def test_what_no_byte_can_stand_for_is_refused(value: float) -> None:
    with pytest.raises(PluginError, match=r"values that are not in 0\.\.1"):
        in_bytes(np.array([[0.5, value]], np.float32))


@pytest.mark.parametrize("size", [54, 6])
@settings(max_examples=6, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), threshold=st.floats(0.0, 0.95))
def test_responses_differ_by_no_more_than_two_roundings_allow(size: int, seed: int, threshold: float) -> None:
    plain, compact = agents(seed, size, threshold)
    exact, found = (agent.compare(*2 * [[agent.describe(observe(i)) for i in range(6)]]) for agent in (plain, compact))
    assert np.abs(found - exact).max() <= 1 / 255 / (1 - threshold) + ROUNDING


@pytest.mark.parametrize("size", [54, 6])
def test_responses_are_those_of_the_rounded_values(size: int) -> None:
    plain, compact = agents(0, size, 0.7)
    kept = [compact.describe(observe(i)) for i in range(9)]
    rounded = [View(view.signatures.astype(np.float32) / np.float32(255), view.azimuths) for view in kept]
    found = compact.compare(kept, kept)
    np.testing.assert_allclose(found, plain.compare(rounded, rounded), atol=ROUNDING)
    assert np.count_nonzero((found > 0.01) & (found < 0.99)) > 9


@pytest.mark.parametrize("size", [54, 6])
def test_streaming_equals_the_matrix_bitwise_and_a_place_knows_its_own_frame(size: int) -> None:
    _, agent = agents(1, size, 0.6)
    frames = [observe(i) for i in range(9)]
    views = [agent.describe(frame) for frame in frames]
    matrix = agent.compare(views, views)
    assert [agent.learn(frame) for frame in [*frames, *frames]] == [*range(9), *9 * [None]]
    np.testing.assert_array_equal([agent.respond(frame) for frame in frames], matrix)
    np.testing.assert_array_equal(matrix.diagonal(), 1.0)


def test_places_take_three_bytes_less_a_value() -> None:
    held = []
    for agent in agents(2, 54, 0.5):
        memory = memory_for(agent.encoder)
        for number in range(16):
            memory.add(agent.describe(observe(number)))
        held.append(held_bytes(memory))
    # 8 units a place; full at 16, 48 and 112 units, there is then room for 2 x 120.
    assert held[0] - held[1] == 3 * 54**2 * 240


def test_by_default_signatures_stay_as_the_encoder_gives_them() -> None:
    encoder = Drawn(3)
    agent, frame = MaxPi(encoder, recognition_threshold=0.5), observe(4)
    kept, given = agent.describe(frame).signatures, encoder.encode(frame["frame"]).signatures
    assert agent.storage == "float32"
    assert kept.dtype == np.float32
    np.testing.assert_array_equal(kept, given)


class Overlapping(Drawn):
    """One that says that it matches by overlap too, whose lists hold no bytes."""

    matches_by_overlap = True


@pytest.mark.parametrize(
    ("encoder", "storage", "named"),
    [
        (Drawn(0), "float16", "storage must be one of float32, uint8, not 'float16'"),
        (Overlapping(0), "uint8", "storage must be 'float32' with an encoder that does not match bytes"),
    ],
)
def test_what_cannot_be_kept_is_refused_by_name(encoder: Drawn, storage: Storage, named: str) -> None:
    with pytest.raises(ConfigError, match=named):
        MaxPi(encoder, storage=storage)


def test_a_configuration_asks_for_it_and_is_told_what_is_wrong_with_it() -> None:
    agent = build({"localizer": "max-pi", "encoder": "log-polar-12", "storage": "uint8"})
    assert isinstance(agent, MaxPi)
    assert agent.storage == "uint8"
    for encoder, storage in (("log-polar", "uint9"), ("hsd-18", "uint8")):
        with pytest.raises(ConfigError, match="storage"):
            build({"localizer": "max-pi", "encoder": encoder, "storage": storage})
