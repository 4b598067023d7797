from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from vprbench_localizers.landmark_vectors import FOLDED, fold_of, landmark_vectors
from vprbench_localizers.unit_activity import View


def test_a_vector_by_hand() -> None:
    view = View(np.array([[9, 0, -16], [0, 0, 0]], np.float32), np.array([pi / 3, pi], np.float32))
    vectors = landmark_vectors(view, fold_of(3), 2.0)
    assert vectors.shape == (2, FOLDED + 2)
    np.testing.assert_allclose(vectors[0, :3], [3 / 5, 0, -4 / 5], atol=1e-6)
    np.testing.assert_allclose(vectors[:, FOLDED:], [[1.0, sqrt(3)], [-2.0, 0.0]], atol=1e-6)
    assert not vectors[:, 3:FOLDED].any()
    assert not vectors[1, :3].any()


def test_each_value_of_a_long_signature_goes_to_one_position_and_all_positions_get_as_many() -> None:
    size = 5 * FOLDED
    vectors = landmark_vectors(View(np.eye(size, dtype=np.float32), np.zeros(size, np.float32)), fold_of(size), 0.0)
    assert np.count_nonzero(vectors, axis=1).tolist() == [1] * size
    assert np.abs(vectors[:, :FOLDED]).sum(axis=0).tolist() == [5] * FOLDED
    assert abs(vectors.sum()) < 4 * sqrt(size)


def test_folding_keeps_products_on_average() -> None:
    random = np.random.default_rng(1)
    signatures = random.random((300, 225)) * (random.random((300, 225)) < 0.03)
    signatures[150:] = np.where(random.random((150, 225)) < 0.5, signatures[:150], signatures[150:])
    vectors = landmark_vectors(View(signatures.astype(np.float32), np.zeros(300, np.float32)), fold_of(225), 0.0)
    roots = np.sqrt(signatures / signatures.sum(axis=1, keepdims=True))
    whole, folded = (np.sum(v[:150] * v[150:], axis=1) for v in (roots, vectors))
    assert np.mean(folded - whole) == pytest.approx(0, abs=0.03)
    assert np.corrcoef(folded, whole)[0, 1] > 0.8
