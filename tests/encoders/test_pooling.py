from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from skimage.measure import block_reduce

from vprbench_encoders.matching_pursuit import SparseCode
from vprbench_encoders.pooling import max_pool, pooled_side, pooling_cells


def sparse(dense: np.ndarray) -> SparseCode:
    """Codes that use a slot for every unit, the units in any order."""
    order = np.random.default_rng(0).permutation(dense.shape[1])
    return SparseCode(np.tile(order, (len(dense), 1)).astype(np.int32), dense[:, order].astype(np.float32))


@pytest.mark.parametrize(("n", "values"), [(12, 36), (15, 64), (18, 81), (21, 100), (24, 144), (30, 225)])
def test_signatures_have_the_sizes_of_the_papers_table(n: int, values: int) -> None:
    assert pooled_side(n, 2) ** 2 == values
    assert pooling_cells(n, 2).max() == values - 1


@pytest.mark.parametrize("side", [12, 18, 24, 30])
def test_an_even_map_is_pooled_as_scikit_image_does(side: int) -> None:
    maps = np.random.default_rng(0).random((3, side, side))
    expected = [block_reduce(one, (2, 2), np.max).ravel() for one in maps]  # type: ignore[no-untyped-call]
    np.testing.assert_allclose(max_pool(sparse(maps.reshape(3, -1)), pooling_cells(side, 2)), expected, rtol=1e-6)


def test_the_last_row_of_15_is_a_window_of_its_own() -> None:
    maps = np.random.default_rng(0).random((15, 15))
    pooled = max_pool(sparse(maps.reshape(1, -1)), pooling_cells(15, 2)).reshape(8, 8)
    assert pooled[7, 7] == np.float32(maps[14, 14])
    assert pooled[7, 0] == np.float32(maps[14, :2].max())
    assert pooled[6, 6] == np.float32(maps[12:14, 12:14].max())


def test_the_last_row_of_21_belongs_to_no_window() -> None:
    maps = np.zeros((21, 21))
    maps[20, :] = maps[:, 20] = 1
    np.testing.assert_array_equal(max_pool(sparse(maps.reshape(1, -1)), pooling_cells(21, 2)), np.zeros((1, 100)))


@given(side=st.integers(2, 40), width=st.integers(1, 5))
def test_windows_are_whole_or_cut_by_the_border_alone(side: int, width: int) -> None:
    width = min(width, side)
    cells = pooling_cells(side, width).reshape(side, side)
    count = pooled_side(side, width)
    for i in range(count):
        rows = np.flatnonzero((cells // count == i).any(axis=1) & (cells >= 0).any(axis=1))
        assert rows.tolist() == list(range(i * width, min((i + 1) * width, side)))


def test_width_1_leaves_the_map_as_it_is() -> None:
    maps = np.random.default_rng(0).random((2, 49))
    np.testing.assert_array_equal(max_pool(sparse(maps), pooling_cells(7, 1)), maps.astype(np.float32))


def test_magnitudes_are_pooled() -> None:
    code = SparseCode(np.array([[0, 1, 3]], np.int32), np.array([[-3, 2, 1]], np.float32))
    np.testing.assert_array_equal(max_pool(code, pooling_cells(2, 2)), [[3]])
