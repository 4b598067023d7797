from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from vprbench.errors import ConfigError
from vprbench_encoders.som import KohonenMap, nearest_units, topographic_error


def gabors(count: int, seed: int = 0) -> NDArray[np.float32]:
    """Oriented edges of any angle and phase: what S1's atoms look like."""
    rng = np.random.default_rng(seed)
    v, u = np.mgrid[-6:7, -6:7]
    angle, phase = np.asarray(rng.uniform(0, 2 * np.pi, (2, count, 1, 1)))
    wave = np.cos(0.9 * (u * np.cos(angle) + v * np.sin(angle)) + phase) * np.exp(-(u**2 + v**2) / 20)
    rows = wave.reshape(count, -1)
    return (rows / np.linalg.norm(rows, axis=1, keepdims=True)).astype(np.float32)


def ordered(samples: NDArray[np.float32], side: int, seed: int = 0) -> NDArray[np.float32]:
    return KohonenMap().order(samples, side, np.random.default_rng(seed))


def correlation_at(units: NDArray[np.float32], side: int, near: int, far: int) -> float:
    """Mean correlation of units whose grid distance is in near..far."""
    grid = np.stack(np.divmod(np.arange(side * side), side), axis=1)
    distance = cdist(grid, grid, "chebyshev")
    correlation = np.asarray(np.corrcoef(units))
    return float(correlation[(distance >= near) & (distance <= far)].mean())


def online(samples: NDArray[np.float32], side: int, seed: int) -> NDArray[np.float32]:
    """The paper's own rule: w <- w + alpha h (x - w), 500 updates a unit."""
    rng = np.random.default_rng(seed)
    units = samples[rng.integers(len(samples), size=side * side)].copy()
    grid = np.stack(np.divmod(np.arange(side * side), side), axis=1)
    updates = 500 * side * side
    for step in range(updates):
        done = step / updates
        sigma, alpha = 4 * (0.5 / 4) ** done, 0.5 * (0.01 / 0.5) ** done
        sample = samples[rng.integers(len(samples))]
        winner = np.square(units - sample).sum(axis=1).argmin()
        h = np.exp(-np.square(grid - grid[winner]).sum(axis=1) / (2 * sigma**2))
        units += (alpha * h)[:, None].astype(np.float32) * (sample - units)
    return units


@pytest.mark.parametrize(("count", "side"), [(144, 12), (100, 20)])
def test_neighbours_on_the_map_are_alike_and_distant_units_are_not(count: int, side: int) -> None:
    units = ordered(gabors(count), side)
    assert correlation_at(units, side, 1, 1) > 0.5
    assert correlation_at(units, side, 1, 1) > correlation_at(units, side, 3, 4) + 0.2
    assert abs(correlation_at(units, side, side // 2, side)) < 0.2


def test_most_samples_have_their_two_nearest_units_side_by_side() -> None:
    atoms = gabors(144)
    assert topographic_error(atoms, ordered(atoms, 12), 12) < 0.15
    assert topographic_error(atoms, atoms, 12) > 0.8


def test_the_batch_rule_is_as_good_as_the_papers_online_rule() -> None:
    atoms = gabors(100)
    batch, slow = ordered(atoms, 8), online(atoms, 8, 0)
    errors = [cdist(atoms, units).min(axis=1).mean() for units in (batch, slow)]
    assert errors[0] < 1.1 * errors[1]
    assert topographic_error(atoms, batch, 8) <= topographic_error(atoms, slow, 8) + 0.1


def test_a_square_of_points_unfolds() -> None:
    points = np.random.default_rng(0).random((2000, 2)).astype(np.float32)
    grid = ordered(points, 8).reshape(8, 8, 2)
    steps = [np.linalg.norm(np.diff(grid, axis=axis), axis=-1) for axis in (0, 1)]
    assert max(step.max() for step in steps) < 0.3
    area = np.cross(np.append(grid[-1, 0] - grid[0, 0], 0), np.append(grid[0, -1] - grid[0, 0], 0))[2]
    assert abs(area) > 0.4


def test_an_epoch_is_the_weighted_mean_of_all_samples() -> None:
    samples = gabors(40)
    start = samples[np.random.default_rng(5).integers(40, size=25)]
    winner = cdist(samples, start).argmin(axis=1)
    grid = np.stack(np.divmod(np.arange(25), 5), axis=1)
    h = np.exp(-cdist(grid, grid[winner], "sqeuclidean") / (2 * 1.5**2))
    expected = h @ samples / h.sum(axis=1, keepdims=True)
    one = KohonenMap(epochs=1, neighbourhood=1.5, final_neighbourhood=1.5)
    np.testing.assert_allclose(one.order(samples, 5, np.random.default_rng(5)), expected, atol=1e-5)


def test_units_far_from_all_samples_stay_finite() -> None:
    units = KohonenMap(epochs=3, neighbourhood=0.3, final_neighbourhood=0.1).order(
        gabors(2), 30, np.random.default_rng(0)
    )
    assert np.isfinite(units).all()
    assert np.linalg.norm(units, axis=1).min() > 0.5


def test_the_same_seed_gives_the_same_map_and_another_seed_another() -> None:
    atoms = gabors(50)
    np.testing.assert_array_equal(ordered(atoms, 6, 1), ordered(atoms, 6, 1))
    assert np.abs(ordered(atoms, 6, 1) - ordered(atoms, 6, 2)).max() > 0.01


def test_nearest_units_are_the_nearest() -> None:
    samples, units = gabors(30, 1), gabors(20, 2)
    expected = np.argsort(cdist(samples, units), axis=1)
    np.testing.assert_array_equal(nearest_units(samples, units)[:, 0], expected[:, 0])
    np.testing.assert_array_equal(nearest_units(samples, units, 3), expected[:, :3])


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"epochs": 0}, "epochs"),
        ({"neighbourhood": 0.1}, "neighbourhood"),
        ({"final_neighbourhood": 0.0}, "neighbourhood"),
    ],
)
def test_impossible_options_are_refused_by_name(options: dict[str, float], named: str) -> None:
    with pytest.raises(ConfigError, match=named):
        KohonenMap(**options)  # type: ignore[arg-type]


def test_ordering_tells_every_epoch() -> None:
    samples = np.random.default_rng(0).standard_normal((50, 3)).astype(np.float32)
    steps = KohonenMap(epochs=7).ordering(samples, 4, np.random.default_rng(0))
    assert [(step.done, step.total) for step in steps] == [(done, 7) for done in range(1, 8)]
