"""What one thread of this machine can do at most, of the kinds of work that the hot paths consist of.

    pytest tests/benchmarks/test_machine.py --benchmark-only

keeps, as `extra_info`, how much is done a second: docs/performance.md holds what is reached against it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit
from pytest_benchmark.fixture import BenchmarkFixture

BILLION = 1e9

# Values of a large matrix, bytes that no cache holds, and the pixels of a frame.
SIDE, MUCH, PIXELS = 2048, 2**30, 642 * 188


def done_a_second(benchmark: BenchmarkFixture, name: str, amount: float) -> None:
    """Keep how many billions of something are done in a second, by the quickest round."""
    if benchmark.stats:
        benchmark.extra_info |= {name: amount / BILLION / benchmark.stats.stats.min}


def loop(body: Any) -> Any:  # noqa: ANN401 - what numba makes
    """A compiled loop, whose sums may be taken in any order."""
    return njit(body, fastmath=True)


@pytest.mark.benchmark(group="what the machine can do")
def test_multiplying(benchmark: BenchmarkFixture) -> None:
    """Multiply-adds of float32, two operations each, by OpenBLAS."""
    matrix = np.random.default_rng(0).random((SIDE, SIDE), np.float32)
    benchmark(lambda: matrix @ matrix)
    done_a_second(benchmark, "gflops", 2 * SIDE**3)


@pytest.mark.benchmark(group="what the machine can do")
def test_reading_memory(benchmark: BenchmarkFixture) -> None:
    """Bytes that are read one after the other, from memory."""
    values, total = np.ones(MUCH // 4, np.float32), loop(lambda values: values.sum())
    total(values[:1])
    benchmark(lambda: total(values))
    done_a_second(benchmark, "gigabytes", MUCH)


@pytest.mark.benchmark(group="what the machine can do")
def test_gathering_pixels(benchmark: BenchmarkFixture) -> None:
    """Values that are read here and there, from an image that lies in the cache."""
    random = np.random.default_rng(0)
    image, places = random.random(PIXELS, np.float32), random.integers(0, PIXELS, 2**20).astype(np.uint32)

    def gathered(image: Any, places: Any) -> Any:  # noqa: ANN401
        total = np.float32(0)
        for place in places:
            total += image[place]
        return total

    total = loop(gathered)
    total(image, places)
    benchmark(lambda: total(image, places))
    done_a_second(benchmark, "values", len(places))
