"""How long the environment itself takes: one step, one reset, and drawing one frame of the embedded street."""

from __future__ import annotations

from itertools import cycle
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import vprbench  # noqa: F401 - registers the environments
from vprbench.catalogue import load_route
from vprbench.route import Route
from vprbench.types import Observation

Env = gym.Env[Observation, dict[str, Any]]
ACTION = {"place": 0, "confidence": np.float32(0.5)}


def play(env: Env, phase: str) -> None:
    env.reset(options={"phase": phase})
    ended = False
    while not ended:
        _, _, ended, _, _ = env.step(ACTION)


@pytest.fixture
def env(street: Route) -> Env:
    """An environment of frames drawn beforehand, ready for the test phase."""
    made: Env = gym.make("vprbench/Route-v0", route=street)
    play(made, "learn")
    play(made, "record")
    return made


@pytest.mark.benchmark(group="environment")
def test_step(benchmark: BenchmarkFixture, env: Env, street: Route) -> None:
    frames = len(street.test)
    position = cycle(range(frames))

    def ready() -> None:
        if next(position) == 0:
            env.reset(options={"phase": "test"})

    benchmark.pedantic(  # type: ignore[no-untyped-call]
        lambda: env.step(ACTION), setup=ready, rounds=50 * frames, warmup_rounds=frames
    )


@pytest.mark.benchmark(group="environment")
def test_reset(benchmark: BenchmarkFixture, env: Env) -> None:
    benchmark(lambda: env.reset(options={"phase": "test"}))


@pytest.mark.benchmark(group="environment")
def test_draw_a_street_frame(benchmark: BenchmarkFixture) -> None:
    frames = load_route("Street-Wide").learn.frames
    index = cycle(range(0, 90, 7))
    # The first call builds the street.
    assert frames[next(index)].any()
    benchmark(lambda: frames[next(index)])
