from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from vprbench_localizers.place_memory import PlaceMemory
from vprbench_localizers.place_search import PROBES, Found, best_place, outline
from vprbench_localizers.region_match import Description, describe_regions, score_places

Cells = NDArray[np.float64]
EVERYWHERE = np.ones((31, 31), bool)


def random_cells(seed: int) -> Cells:
    random = np.random.default_rng(seed)
    return random.random((32, 32, 8)) ** 4 * (random.random((32, 32, 1)) >= 0.3)


def look_alike(cells: Cells, amount: float, seed: int) -> Cells:
    return (1 - amount) * cells + amount * random_cells(seed)


def remember(*places: Cells) -> PlaceMemory:
    return PlaceMemory.of([describe_regions(cells, EVERYWHERE).planes for cells in places])


def search(query: Description, memory: PlaceMemory, threads: int = 1) -> Found:
    return best_place(query, memory.planes, memory.outlines, threads)


def scores(query: Description, memory: PlaceMemory) -> NDArray[np.float32]:
    scores = np.empty(len(memory), np.float32)
    score_places(query, memory.planes, scores)
    return scores


@settings(max_examples=25)
@given(
    seed=st.integers(0, 2**32 - 1),
    amounts=st.lists(st.sampled_from([0.0, 0.001, 0.01, 0.1, 0.5, 1.0]), min_size=1, max_size=40),
    share=st.sampled_from([0.0, 0.01, 0.3, 1.0]),
    threads=st.integers(1, 3),
)
def test_it_finds_the_first_of_the_best_bit_by_bit(seed: int, amounts: list[float], share: float, threads: int) -> None:
    cells, random = random_cells(seed), np.random.default_rng(seed)
    query = describe_regions(cells, random.random((31, 31)) < share)
    # Seeds repeat, so that some places are equal.
    memory = remember(*(look_alike(cells, amount, int(random.integers(4))) for amount in amounts))
    every = scores(query, memory)
    found = search(query, memory, threads)
    assert (found.place, found.response) == (int(every.argmax()), float(every.max()))
    assert 0 <= found.matched <= 1


def test_places_that_share_nothing_are_left_after_one_strip() -> None:
    cells, empty, others = random_cells(1) + 0.01, np.zeros((32, 32, 8)), 40
    found = search(describe_regions(cells, EVERYWHERE), remember(*[empty] * others, cells))
    assert found.place == others
    # The first visited are matched whole; of the rest four rows of 31 regions, of 31 rows.
    rest = others + 1 - PROBES
    assert found.matched == pytest.approx((PROBES * 31 + rest * 4) / (31 * (others + 1)))


def test_places_that_look_alike_are_all_matched() -> None:
    cells = random_cells(2)
    found = search(describe_regions(cells, EVERYWHERE), remember(*[cells] * 20))
    assert (found.place, found.matched) == (0, 1.0)


def test_without_places_none_is_found() -> None:
    for threads in (1, 2):
        assert search(describe_regions(random_cells(0), EVERYWHERE), PlaceMemory(), threads) == (-1, 0.0, 0.0)


def test_a_query_without_kept_regions_responds_nothing() -> None:
    found = search(describe_regions(random_cells(0), ~EVERYWHERE), remember(*map(random_cells, range(20))))
    assert found == (0, 0.0, 0.0)


def test_an_outline_is_the_mean_root_of_each_field_at_unit_length() -> None:
    cells = np.zeros((32, 32, 8))
    # A whole field of strength 4 in one direction; in another field one of 64 cells, of strength 64 * 64.
    cells[8:16, 24:32, 3] = 4.0
    cells[31, 0, 5] = 4096.0
    fields = outline(describe_regions(cells, EVERYWHERE).planes).reshape(4, 8, 4)
    expected = np.zeros((4, 8, 4))
    expected[1, 3, 3], expected[3, 5, 0] = 2.0, 1.0
    np.testing.assert_allclose(fields, expected / np.sqrt(5), atol=1e-6)
    assert not outline(describe_regions(np.zeros((32, 32, 8)), EVERYWHERE).planes).any()
