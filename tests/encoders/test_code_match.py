from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from vprbench_encoders.code_match import Similarity, match_all, match_pairs

EACH = pytest.mark.parametrize("similarity", ["overlap", "cosine"])


def codes(seed: int, rows: int, size: int = 225) -> NDArray[np.float32]:
    """Sparse codes of five values each."""
    rng = np.random.default_rng(seed)
    values = np.zeros((rows, size), np.float32)
    chosen = rng.integers(0, size, (rows, 5))
    np.put_along_axis(values, chosen, rng.uniform(0.1, 5, (rows, 5)).astype(np.float32), axis=1)
    return values


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), points=st.integers(1, 9), units=st.integers(1, 9), size=st.integers(2, 40))
def test_both_similarities_are_scipys(seed: int, points: int, units: int, size: int) -> None:
    queries, memory = codes(seed, points, size), codes(seed + 1, units, size)
    for similarity, metric in (("overlap", "braycurtis"), ("cosine", "cosine")):
        match = match_all(queries, memory, similarity)  # type: ignore[arg-type]
        assert match.dtype == np.float32 and match.flags.c_contiguous
        np.testing.assert_allclose(match, 1 - cdist(queries, memory, metric), atol=1e-6)  # type: ignore[call-overload]


@EACH
def test_equal_rows_match_with_1_and_disjoint_ones_with_0(similarity: Similarity) -> None:
    one, other = np.zeros((2, 1, 6), np.float32)
    one[0, :3], other[0, 3:] = 2, 2
    assert match_all(one, one, similarity)[0, 0] == 1
    assert match_all(one, other, similarity)[0, 0] == 0


@EACH
def test_a_row_of_zeros_matches_only_its_like(similarity: Similarity) -> None:
    rows = np.array([[0, 0], [1, 2]], np.float32)
    np.testing.assert_array_equal(match_all(rows, rows, similarity), [[1, 0], [0, 1]])


def test_cosine_knows_no_contrast_and_overlap_does() -> None:
    row = codes(0, 1)
    assert match_all(row, 2 * row, "cosine")[0, 0] == pytest.approx(1)
    assert match_all(row, 2 * row, "overlap")[0, 0] == pytest.approx(2 / 3)


@EACH
def test_chosen_pairs_match_bitwise_as_all_pairs_do(similarity: Similarity) -> None:
    queries, memory = codes(0, 25), codes(1, 40)
    p, m = np.random.default_rng(2).integers(0, [[25], [40]], (2, 300))
    np.testing.assert_array_equal(
        match_pairs(queries, memory, p, m, similarity), match_all(queries, memory, similarity)[p, m]
    )


@EACH
def test_nothing_matches_nothing(similarity: Similarity) -> None:
    assert match_all(codes(0, 0), codes(1, 3), similarity).shape == (0, 3)
    assert match_all(codes(0, 3), codes(1, 0), similarity).shape == (3, 0)
