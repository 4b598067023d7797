from __future__ import annotations

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from vprbench_localizers.region_match import REGIONS, describe_regions, match_rows, room_to_match, score_places

Cells = NDArray[np.float64]
SEEDS = st.integers(0, 2**32 - 1)


def score(query: Cells, kept: NDArray[np.bool_], *places: Cells, threads: int = 1) -> NDArray[np.float32]:
    scores = np.full(len(places), np.nan, np.float32)
    planes = np.stack([describe_regions(cells, kept).planes for cells in places])
    score_places(describe_regions(query, kept), planes, scores, threads)
    return scores


def keep(*regions: tuple[int, int]) -> NDArray[np.bool_]:
    kept = np.zeros((31, 31), bool)
    for region in regions:
        kept[region] = True
    return kept


def lit(*positions: tuple[int, int]) -> Cells:
    """Cells that are empty but for the first direction of some."""
    cells = np.zeros((32, 32, 8))
    for row, column in positions:
        cells[row, column, 0] = 1.0
    return cells


def random_cells(seed: int, empty: float = 0.3) -> Cells:
    random = np.random.default_rng(seed)
    return random.random((32, 32, 8)) * 1e6 * (random.random((32, 32, 1)) >= empty)


def descriptors(cells: Cells) -> NDArray[np.float64]:
    """The 961 descriptors of 32 values: four cells in reading order, at unit length unless zero."""
    rows = np.array([cells[i : i + 2, j : j + 2].reshape(32) for i, j in product(range(31), repeat=2)])
    norms = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.divide(rows, norms, out=np.zeros_like(rows), where=norms > 0)


@settings(deadline=None, max_examples=30)
@given(query_seed=SEEDS, place_seed=SEEDS, share=st.sampled_from([0.001, 0.03, 0.5, 1.0]))
def test_the_score_is_that_of_the_whole_matrix_of_products(query_seed: int, place_seed: int, share: float) -> None:
    query, places = random_cells(query_seed), [random_cells(place_seed), random_cells(query_seed + 1, empty=0.9)]
    kept = np.random.default_rng(place_seed).random((31, 31)) < share
    rows = descriptors(query)[kept.ravel()]
    best = [(rows @ descriptors(place).T).max(axis=1) for place in places]
    expected = [cosines.mean() if len(rows) else 0.0 for cosines in best]
    np.testing.assert_allclose(score(query, kept, *places), expected, atol=1e-6)


def shares(query: Cells, kept: NDArray[np.bool_], place: Cells, bounds: list[int]) -> NDArray[np.float64]:
    """What each row of regions adds to the score, matched in strips that begin and end at these rows."""
    asking, buffers, shares = room_to_match(describe_regions(query, kept))
    planes = describe_regions(place, kept).planes
    for first, last in pairwise([0, *bounds, REGIONS]):
        match_rows(asking, planes, first, last, buffers, shares)
    return shares


BOUNDS = st.lists(st.integers(0, REGIONS), max_size=4).map(sorted)


@settings(deadline=None, max_examples=30)
@given(seed=SEEDS, bounds=BOUNDS, border=st.booleans())
def test_each_row_adds_the_best_products_of_its_regions(seed: int, bounds: list[int], border: bool) -> None:
    query, place = random_cells(seed), random_cells(seed + 1, empty=0.9)
    kept = np.random.default_rng(seed).random((31, 31)) < 0.5
    if border:
        kept[1:-1, 1:-1] = False
    best = (descriptors(query) @ descriptors(place).T).max(axis=1).reshape(31, 31)
    expected = (best * kept).sum(axis=1) / kept.sum()
    np.testing.assert_allclose(shares(query, kept, place, bounds), expected, atol=1e-7)


@settings(deadline=None, max_examples=30)
@given(seed=SEEDS, bounds=BOUNDS)
def test_what_a_row_adds_does_not_depend_on_the_strips_by_one_bit(seed: int, bounds: list[int]) -> None:
    query, place, kept = random_cells(seed), random_cells(seed + 1), np.ones((31, 31), bool)
    assert shares(query, kept, place, bounds).tolist() == shares(query, kept, place, []).tolist()


CORNERS = [(0, 0), (0, 1), (1, 0), (1, 1)]


@pytest.mark.parametrize(("asked", "offered"), list(product(CORNERS, CORNERS)))
def test_cells_match_only_at_the_same_corner_of_a_region(asked: tuple[int, int], offered: tuple[int, int]) -> None:
    query = lit((10 + asked[0], 20 + asked[1]))
    # A cell in a corner of the image is in one region only, at that corner.
    place = lit((31 * offered[0], 31 * offered[1]))
    assert score(query, keep((10, 20)), place) == pytest.approx(1.0 if asked == offered else 0.0)


@pytest.mark.parametrize("region", [(0, 0), (0, 30), (30, 0), (30, 30), (15, 16)])
def test_one_region_by_hand(region: tuple[int, int]) -> None:
    query, place = lit(), lit()
    row, column = region
    query[row, column, 2], query[row + 1, column + 1, 5] = 3.0, 4.0
    place[8, 9, 2], place[9, 10, 5], place[9, 10, 6] = 2.0, 1.0, 2.0
    # (3, 4, 0) / 5 with (2, 1, 2) / 3, against 3 / 5 and 4 / 5 sqrt(1 / 5) where a region has one of the two cells.
    assert score(query, keep(region), place) == pytest.approx(10 / 15, rel=1e-6)


def test_only_kept_regions_ask_and_all_regions_answer() -> None:
    query, place = lit((2, 2), (20, 20)), lit((31, 31))
    assert score(query, keep((1, 1)), place) == pytest.approx(1.0)
    assert score(query, keep((20, 20)), place) == 0.0
    assert score(query, keep((1, 1), (20, 20)), place) == pytest.approx(0.5)


def test_a_kept_region_without_gradient_finds_nothing() -> None:
    cells = lit((5, 5))
    assert score(cells, keep((5, 5)), cells) == 1.0
    assert score(cells, keep((5, 5), (25, 25)), cells) == 0.5


@given(seed=SEEDS)
def test_a_frame_matches_itself_and_no_other_as_well(seed: int) -> None:
    cells, other = random_cells(seed, empty=0.0), random_cells(seed + 1, empty=0.0)
    own, foreign = score(cells, np.ones((31, 31), bool), cells, other)
    assert 1 - 1e-6 <= own <= 1
    assert 0 <= foreign < own


def test_rounding_does_not_lift_a_score_above_one() -> None:
    cells = random_cells(6, empty=0.0)
    own = [score(cells, keep((i, j)), cells)[0] for i, j in product(range(0, 31, 3), repeat=2)]
    assert 1 - 1e-6 <= min(own) <= max(own) == 1


def test_without_kept_regions_or_gradients_the_score_is_zero() -> None:
    cells, empty = random_cells(0), lit()
    everywhere, nowhere = np.ones((31, 31), bool), keep()
    assert score(cells, nowhere, cells, empty).tolist() == [0.0, 0.0]
    assert score(empty, everywhere, cells, empty).tolist() == [0.0, 0.0]
    assert score(cells, everywhere, empty) == 0.0


@pytest.mark.parametrize("factor", [1e-6, 2.0, 1e4])
def test_contrast_does_not_count(factor: float) -> None:
    query, place, kept = random_cells(1), random_cells(2), np.ones((31, 31), bool)
    plain = score(query, kept, place)
    np.testing.assert_allclose(score(query * factor, kept, place), plain, rtol=1e-5)
    np.testing.assert_allclose(score(query, kept, place * factor), plain, rtol=1e-5)


def test_the_score_does_not_depend_on_the_other_places_by_one_bit() -> None:
    query, places = random_cells(3), [random_cells(seed) for seed in range(4, 9)]
    kept = np.random.default_rng(0).random((31, 31)) < 0.4
    together = score(query, kept, *places)
    alone = [score(query, kept, place)[0] for place in places]
    assert together.tolist() == alone


@pytest.mark.parametrize("threads", [2, 3, 5, 8])
def test_the_score_does_not_depend_on_the_number_of_threads_by_one_bit(threads: int) -> None:
    query, places = random_cells(3), [random_cells(seed) for seed in range(4, 9)]
    kept = np.random.default_rng(0).random((31, 31)) < 0.4
    assert score(query, kept, *places, threads=threads).tolist() == score(query, kept, *places).tolist()


def test_no_places_get_no_scores_on_any_number_of_threads() -> None:
    query, none = describe_regions(random_cells(3), keep()), np.empty(0, np.float32)
    for threads in (1, 2):
        score_places(query, np.empty((0, *query.planes.shape), np.float32), none, threads)
