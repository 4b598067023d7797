from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench_encoders.hsd_patterns import cells_combined, expected_units, preferred_patterns
from vprbench_encoders.layers import TopologicalLayer
from vprbench_encoders.matching_pursuit import by_correlation
from vprbench_encoders.pooling import pooling_cells


def floats(values: object) -> np.ndarray:
    return np.array(values, np.float32)


EDGES = floats([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.6, 0.8, 0]])


def test_a_cell_stands_for_the_mean_of_its_window_weighted_by_usage() -> None:
    expected = expected_units(EDGES, floats([0.3, 0.1, 0, 0]), np.zeros(4, np.int64))
    np.testing.assert_allclose(expected, [[0.75, 0.25, 0]], atol=1e-6)


def test_a_window_that_is_never_used_stands_for_the_plain_mean() -> None:
    expected = expected_units(EDGES, floats([0, 0, 0.2, 0]), np.array([0, 0, 1, 1]))
    np.testing.assert_allclose(expected, floats([[0.5, 0.5, 0], [0, 0, 1]]), atol=1e-6)


def test_a_unit_in_no_window_stands_for_nothing() -> None:
    expected = expected_units(EDGES, floats([0.5, 0.5, 0.5, 0.5]), np.array([0, 1, -1, -1]))
    np.testing.assert_allclose(expected, EDGES[:2], atol=1e-6)


def test_patterns_of_a_two_layer_dictionary_by_hand() -> None:
    """Each window of S1's 4 x 4 map is used in one unit only; S2 has a unit for one cell, and one for two."""
    units = np.eye(16, dtype=np.float32)
    usage = np.zeros(16, np.float32)
    usage[[0, 7, 12, 10]] = [0.1, 0.9, 0.4, 0.2]
    second = floats([[0, 1, 0, 0], [0.6, 0, -0.2, 0.8]])
    patterns = preferred_patterns(second, expected_units(units, usage, pooling_cells(4, 2)))
    # Cells 0 to 3 hold units {0, 1, 4, 5}, {2, 3, 6, 7}, {8, 9, 12, 13} and {10, 11, 14, 15}.
    np.testing.assert_allclose(patterns, np.stack([units[7], 0.6 * units[0] + 0.8 * units[10]]), atol=1e-6)


def test_a_unit_that_looks_for_nothing_has_an_empty_pattern() -> None:
    np.testing.assert_array_equal(preferred_patterns(floats([[-1, 0]]), floats([[1, 0], [0, 1]])), [[0, 0]])


@given(st.integers(0, 2**32 - 1))
def test_no_input_of_the_same_strength_excites_a_unit_more(seed: int) -> None:
    """What `preferred_patterns` says of the positive part, tried on random non-negative inputs."""
    random = np.random.default_rng(seed)
    unit, mean = random.standard_normal(9), random.random(9)
    preferred = np.maximum(unit, 0)
    if not preferred.any():
        return
    others = random.random((500, 9)) * (random.random((500, 9)) < 0.4)
    others *= (np.linalg.norm(preferred) / np.maximum(np.linalg.norm(others, axis=1), 1e-9))[:, None]
    assert ((others - mean) @ unit <= (preferred - mean) @ unit + 1e-9).all()


def test_a_view_drawn_from_a_pattern_excites_the_cells_that_its_unit_looks_for() -> None:
    """The way back is checked by the way forth: coding and pooling a pattern gives its unit's cells."""
    units = np.linalg.qr(np.random.default_rng(0).standard_normal((30, 16)))[0].T.astype(np.float32)
    cells = pooling_cells(4, 2)
    layer = TopologicalLayer(units, np.zeros(30, np.float32), by_correlation(16), cells, picks=4, rectified=True)
    usage = np.zeros(16, np.float32)
    usage[[5, 6, 8, 15]] = 0.25
    second = floats([[0.8, 0.6, 0, 0], [0, 0, 1, 0], [-0.5, 0.1, 0.2, 0.4]])
    pooled = layer.pooled(preferred_patterns(second, expected_units(units, usage, cells)))
    wanted = np.maximum(second, 0)
    np.testing.assert_allclose(
        pooled / np.linalg.norm(pooled, axis=1, keepdims=True),
        wanted / np.linalg.norm(wanted, axis=1, keepdims=True),
        atol=1e-5,
    )


def test_cells_combined_counts_cells_of_equal_weight() -> None:
    second = floats([[0, 3, 0, 0], [1, 1, -5, 0], [2, 2, 2, 2], [1, 2, 0, 0], [0, -1, 0, 0]])
    np.testing.assert_allclose(cells_combined(second), [1, 2, 4, 1 / (0.2**2 + 0.8**2), 0], rtol=1e-6)


@pytest.mark.parametrize("width", [1, 2, 3])
def test_units_that_are_alike_give_cells_that_are_theirs(width: int) -> None:
    cells = pooling_cells(6, width)
    window = np.random.default_rng(1).standard_normal((int(cells.max()) + 1, 7)).astype(np.float32)
    units = np.where(cells[:, None] >= 0, window[cells], np.float32(np.nan))
    usage = np.random.default_rng(2).random(36, np.float32)
    pooled = cells >= 0
    np.testing.assert_allclose(expected_units(units[pooled], usage[pooled], cells[pooled]), window, rtol=1e-5)
