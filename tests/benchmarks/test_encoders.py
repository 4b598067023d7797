"""How long each registered encoder takes to encode one frame."""

from __future__ import annotations

from collections.abc import Callable
from itertools import cycle

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from vprbench.observation import Drive
from vprbench.plugins import plugins
from vprbench.protocols import Encoder
from vprbench.route import Route


@pytest.mark.benchmark(group="encode one frame")
@pytest.mark.parametrize("name", plugins("encoder"))
def test_encode(
    benchmark: BenchmarkFixture, street: Route, fitted_encoder: Callable[[str], Encoder], name: str
) -> None:
    encoder, frames = fitted_encoder(name), cycle([observation["frame"] for observation in Drive(street.test)])
    # The first call may compile.
    landmarks = encoder.encode(next(frames))
    benchmark.extra_info |= {"encoder": name, "signature_size": landmarks.signatures.shape[1]}
    benchmark(lambda: encoder.encode(next(frames)))
