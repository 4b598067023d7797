from __future__ import annotations

from math import pi, sqrt

import faiss
import numpy as np
import pytest
from numpy.typing import NDArray

from vprbench.errors import ConfigError
from vprbench_localizers import landmark_index
from vprbench_localizers.landmark_index import LandmarkIndex, landmark_vectors, require_faiss
from vprbench_localizers.unit_activity import View


def random_vectors(seed: int, count: int) -> NDArray[np.float32]:
    random = np.random.default_rng(seed)
    signatures = random.random((count, 30), np.float32) * (random.random((count, 30)) < 0.2)
    return landmark_vectors(View(signatures, random.uniform(-pi, pi, count).astype(np.float32)), 1.0)


def test_a_vector_by_hand() -> None:
    view = View(np.array([[9, 0, -16], [0, 0, 0]], np.float32), np.array([pi / 3, pi], np.float32))
    vectors = landmark_vectors(view, 2.0)
    assert vectors.shape == (2, 16)
    np.testing.assert_allclose(vectors[0, :5], [3 / 5, 0, -4 / 5, 1, sqrt(3)], atol=1e-6)
    np.testing.assert_allclose(vectors[1, :5], [0, 0, 0, -2, 0], atol=1e-6)
    assert not vectors[:, 5:].any()


def test_looking_into_every_list_finds_what_comparing_all_finds() -> None:
    stored, queries = random_vectors(1, 2000), random_vectors(2, 20)
    index = LandmarkIndex(random_vectors(3, 300), lists=16, probes=16)
    index.add(stored[:700])
    index.add(stored[700:])
    order = np.argsort(-(queries @ stored.T), axis=1)
    for query, nearest in zip(queries, order, strict=True):
        found = index.nearest(query[None], 10)
        # A value of one byte rounds: what is found is among few more.
        assert len(found) == 10
        assert nearest[0] in found
        assert set(found) <= set(nearest[:20])


def test_numbers_come_once_and_rising_and_no_more_than_there_are() -> None:
    index = LandmarkIndex(random_vectors(3, 4), lists=100, probes=4)
    assert index.nearest(random_vectors(2, 3), 5).tolist() == []
    index.add(random_vectors(1, 3))
    assert index.nearest(random_vectors(2, 3), 5).tolist() == [0, 1, 2]
    index.clear()
    assert index.nearest(random_vectors(2, 3), 5).tolist() == []


def test_it_works_on_one_thread_and_without_a_word(capfd: pytest.CaptureFixture[str]) -> None:
    faiss.omp_set_num_threads(2)
    LandmarkIndex(random_vectors(3, 40), lists=20, probes=4)
    assert faiss.omp_get_max_threads() == 1
    assert capfd.readouterr() == ("", "")


def test_the_same_samples_make_the_same_index() -> None:
    found = []
    for _ in range(2):
        index = LandmarkIndex(random_vectors(3, 300), lists=32, probes=1)
        index.add(random_vectors(1, 500))
        found.append(index.nearest(random_vectors(2, 20), 3).tolist())
    assert found[0] == found[1]


def test_without_faiss_one_is_told_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(landmark_index, "find_spec", lambda name: None)
    with pytest.raises(ConfigError, match=r"pip install 'vprbench\[ann\]'$"):
        require_faiss()
