from __future__ import annotations

from math import inf, pi
from sys import getsizeof

import faiss
import numpy as np
import pytest
from numpy.typing import NDArray

from vprbench.errors import ConfigError
from vprbench_localizers import landmark_index
from vprbench_localizers.landmark_index import RADIUS, LandmarkIndex, require_faiss
from vprbench_localizers.landmark_vectors import fold_of, landmark_vectors
from vprbench_localizers.unit_activity import View


def views(seed: int, count: int) -> list[View]:
    """Of one landmark each."""
    random = np.random.default_rng(seed)
    signatures = random.random((count, 1, 30), np.float32) * (random.random((count, 1, 30)) < 0.2)
    azimuths = random.uniform(-pi, pi, (count, 1)).astype(np.float32)
    return [View(*pair) for pair in zip(signatures, azimuths, strict=True)]


def samples(seed: int, count: int) -> NDArray[np.float32]:
    return np.concatenate([view.signatures for view in views(seed, count)])


def filled(
    places: list[View], *, looks: int = 16, probes: int = 16, likeness: float = 0.0, span: float = pi
) -> LandmarkIndex:
    index = LandmarkIndex(samples(3, 300), looks=looks, probes=probes, likeness=likeness, span=span)
    for place, view in enumerate(places):
        index.add(view, place)
    return index


@pytest.mark.parametrize(("span", "radius"), [(pi, RADIUS), (inf, 0.0)])
def test_looking_into_every_list_finds_what_comparing_all_finds(span: float, radius: float) -> None:
    stored = views(1, 2000)
    index, fold = filled(stored, span=span), fold_of(30)
    vectors = np.concatenate([landmark_vectors(view, fold, radius) for view in stored])
    for query in views(2, 20):
        products = (landmark_vectors(query, fold, radius) @ vectors.T)[0] - radius**2
        found, order = index.places_like(query, 2000), np.argsort(-products)
        # A value of one byte rounds.
        assert set(np.flatnonzero(products > 0.1)) <= set(found) <= set(np.flatnonzero(products > -0.1))
        assert set(order[:3]) <= set(index.places_like(query, 20)) <= set(order[:60])


def test_landmarks_less_alike_than_the_likeness_do_not_count() -> None:
    """Of codes (1, 0) and (x, 1 - x), by root and at unit length, the product is the root of x."""
    shares = np.linspace(0, 1, 21)
    codes = np.stack([shares, 1 - shares], axis=1).astype(np.float32)
    index = LandmarkIndex(np.eye(2, dtype=np.float32), looks=2, probes=2, likeness=0.71, span=inf)
    for place, code in enumerate(codes):
        index.add(View(code[None], np.zeros(1, np.float32)), place)
    found = index.places_like(View(np.array([[1, 0]], np.float32), np.zeros(1, np.float32)), 21)
    assert found.tolist() == np.flatnonzero(np.sqrt(shares) > 0.71).tolist()


def test_landmarks_further_apart_than_the_span_and_a_sector_are_not_looked_at() -> None:
    code = np.ones((1, 30), np.float32)
    around = np.linspace(-pi, pi, 361)[:-1].astype(np.float32)
    index = filled([View(code, azimuth[None]) for azimuth in around], likeness=-9.0, span=0.2)
    for azimuth in around[::7]:
        apart = np.abs((around - azimuth + pi) % (2 * pi) - pi)
        found = index.places_like(View(code, azimuth[None]), 400)
        assert set(np.flatnonzero(apart < 0.199)) <= set(found) <= set(np.flatnonzero(apart < 0.2 + 2 * pi / 36))


def test_places_that_share_more_of_a_querys_landmarks_come_first() -> None:
    code, directions = np.eye(3, 30, dtype=np.float32), np.array([-1, 0, 1], np.float32)
    kept = [[0], [0, 1, 2], [1, 2], [2]]
    index = filled([View(code[rows], directions[rows]) for rows in kept])
    query = View(code, directions)
    assert index.places_like(query, 5).tolist() == [0, 1, 2, 3]
    assert index.places_like(query, 2).tolist() == [1, 2]
    assert index.places_like(query, 1).tolist() == [1]


def test_there_are_no_more_places_than_were_added() -> None:
    index, (query,) = LandmarkIndex(samples(3, 4), looks=100, probes=40, likeness=-99.0, span=pi), views(2, 1)
    assert index.places_like(query, 5).tolist() == []
    for place, view in enumerate(views(1, 3)):
        index.add(view, place)
    assert index.places_like(query, 5).tolist() == [0, 1, 2]
    index.clear()
    assert index.places_like(query, 5).tolist() == []


def test_it_works_on_one_thread_and_without_a_word(capfd: pytest.CaptureFixture[str]) -> None:
    faiss.omp_set_num_threads(2)
    LandmarkIndex(samples(3, 40), looks=20, probes=4, likeness=0.3, span=0.1)
    assert faiss.omp_get_max_threads() == 1
    assert capfd.readouterr() == ("", "")


def test_the_same_samples_make_the_same_index() -> None:
    one, other = (filled(views(1, 500), looks=32, probes=1, span=1.0) for _ in range(2))
    for query in views(2, 20):
        assert one.places_like(query, 3).tolist() == other.places_like(query, 3).tolist()


def test_without_faiss_one_is_told_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(landmark_index, "find_spec", lambda name: None)
    with pytest.raises(ConfigError, match=r"pip install 'vprbench\[ann\]'$"):
        require_faiss()


def test_its_size_tells_what_faiss_keeps() -> None:
    index = filled([])
    empty = getsizeof(index)
    for place, view in enumerate(views(1, 100)):
        index.add(view, place)
    # 62 values of a look, two of an azimuth, and a place of 8 bytes.
    assert getsizeof(index) - empty == 100 * (64 + 8)
    index.clear()
    assert getsizeof(index) == empty
