"""A memory that looks only at what a query has in common with it answers as one that compares every pair."""

from __future__ import annotations

from math import inf, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from vprbench.errors import PluginError
from vprbench.types import Frame, Landmarks
from vprbench_localizers.max_pi import MaxPi
from vprbench_localizers.memory import Memory, SegmentedMemory
from vprbench_localizers.overlap_memory import OverlapMemory
from vprbench_localizers.pair_memory import PairMemory
from vprbench_localizers.posting_lists import SECTORS
from vprbench_localizers.unit_activity import Rule, View

Codes = NDArray[np.float32]


class Overlap:
    """An encoder that adds up what two codes share in numpy, value by value."""

    matches_by_overlap = True

    def fit(self, frames: object) -> None: ...

    def encode(self, frame: Frame) -> Landmarks:
        raise NotImplementedError

    def match(self, queries: Codes, memory: Codes) -> Codes:
        a, b = queries[:, None], memory[None]
        shares = np.where(a * b > 0, np.minimum(abs(a), abs(b)), np.float32(0))
        one, other, common = (np.cumsum(v, axis=-1, dtype=np.float32)[..., -1] for v in (abs(a), abs(b), shares))
        with np.errstate(invalid="ignore"):
            return np.where(one + other > 0, np.float32(2) * common / (one + other), np.float32(1))


def views(seed: int, count: int, *, size: int = 12, signed: bool = False, points: int = 7) -> list[View]:
    """Places of up to so many landmarks, with codes of up to five values, some of none."""
    rng = np.random.default_rng(seed)
    made = []
    for n in rng.integers(0, points + 1, count):
        codes = np.zeros((n, size), np.float32)
        chosen = rng.integers(0, size, (n, 5))
        amounts = rng.uniform(-5 if signed else 0.1, 5, (n, 5)) * rng.integers(0, 2, (n, 1))
        np.put_along_axis(codes, chosen, amounts.astype(np.float32), axis=1)
        made.append(View(codes, rng.uniform(-pi, pi, n).astype(np.float32)))
    return made


def filled(memory: Memory, places: list[View]) -> Memory:
    assert [memory.add(place) for place in places] == list(range(len(places)))
    return memory


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    signed=st.booleans(),
    threshold=st.floats(0.0, 0.9),
    width=st.sampled_from([0.01, 0.1, 1.0, 4.0, inf]),
    widths=st.floats(0.5, 4.0),
    full=st.sampled_from([None, 1, 7, 20]),
)
def test_it_answers_bitwise_as_comparing_every_pair_does(
    seed: int, signed: bool, threshold: float, width: float, widths: float, full: int | None
) -> None:
    places, queries = views(seed, 20, signed=signed), views(seed + 1, 3, signed=signed)
    rule = Rule(threshold, width, width * widths)
    sparse, dense = filled(OverlapMemory(full), places), filled(PairMemory(Overlap()), places)
    for query in [*queries, *places[:3]]:
        np.testing.assert_array_equal(sparse.respond(query, rule), dense.respond(query, rule))


def test_lists_of_many_blocks_lose_nothing() -> None:
    """All units use the same few values in few directions, so that lists run over many blocks."""
    places = views(0, 300, size=3)
    for place in places:
        place.azimuths[:] = np.round(place.azimuths) * np.float32(0.9)
    assert sum(len(place.azimuths) for place in places) > 1000
    rule = Rule(0.3, 0.1, 0.3)
    sparse, dense = filled(OverlapMemory(), places), filled(PairMemory(Overlap()), places)
    query = max(places, key=lambda place: np.count_nonzero(place.signatures))
    np.testing.assert_array_equal(sparse.respond(query, rule), dense.respond(query, rule))
    assert np.count_nonzero(sparse.respond(query, rule)) > 100


def test_a_full_memory_keeps_no_room() -> None:
    places = views(3, 40)
    roomy, full = OverlapMemory(), OverlapMemory(40)
    values = 0
    for place in places:
        # A code of nothing is listed once.
        values += int(np.maximum(np.count_nonzero(place.signatures, axis=1), 1).sum())
        roomy.add(place)
        full.add(place)
    assert len(full._postings.units) == len(full._postings.values) == values < len(roomy._postings.units) / 2


@pytest.mark.parametrize("turn", [0.0, 0.29, -0.29, 0.31, -0.31, pi])
def test_directions_agree_up_to_the_reach_wherever_sectors_end(turn: float) -> None:
    code = np.array([[0.0, 2.0]], np.float32)
    for azimuth in np.linspace(-pi, pi, 5 * SECTORS + 1):
        memory = OverlapMemory()
        memory.add(View(code, np.array([azimuth], np.float32)))
        seen = (azimuth + turn + pi) % (2 * pi) - pi
        response = memory.respond(View(code, np.array([seen], np.float32)), Rule(0.0, inf, 0.3))
        assert response.tolist() == [abs(turn) < 0.3]


def test_codes_of_nothing_match_each_other_and_nothing_else() -> None:
    nothing, something = np.zeros((1, 4), np.float32), np.ones((1, 4), np.float32)
    ahead, rule = np.zeros(1, np.float32), Rule(0.0, 1.0, 1.0)
    memory = filled(OverlapMemory(), [View(nothing, ahead), View(something, ahead)])
    assert memory.respond(View(nothing, ahead), rule).tolist() == [1, 0]
    assert memory.respond(View(something, ahead), rule).tolist() == [0, 1]


def test_a_response_worked_by_hand() -> None:
    """Codes (3, 1) and (1, 1) share 2 of 6: a match of 2/3, a third above the threshold of 1/2."""
    seen, held = np.array([[3, 1]], np.float32), np.array([[1, 1], [0, 0]], np.float32)
    memory = filled(OverlapMemory(), [View(held, np.array([0.1, 0.1], np.float32))])
    response = memory.respond(View(seen, np.zeros(1, np.float32)), Rule(0.5, 0.1, 0.3))
    np.testing.assert_allclose(response, [(1 / 3 * np.exp(-0.5) + 0) / 2], rtol=1e-5)


def test_max_pi_takes_it_for_an_encoder_that_says_so() -> None:
    class Silent(Overlap):
        matches_by_overlap = False

    places, queries = views(3, 130), views(4, 5)
    one, other = (MaxPi(encoder, recognition_threshold=0.2) for encoder in (Overlap(), Silent()))
    expected = other.compare(queries, places)
    np.testing.assert_array_equal(one.compare(queries, places), expected)
    assert np.count_nonzero(expected) > 0
    assert isinstance(one._memory._make(), OverlapMemory)
    assert isinstance(other._memory._make(), PairMemory)


@pytest.mark.parametrize("places", [1, 7, 20, 21])
def test_segments_answer_as_one_memory_does(places: int) -> None:
    stored, rule = views(5, 20), Rule(0.2, 1.0, 3.0)
    whole, parts = filled(OverlapMemory(), stored), filled(SegmentedMemory(OverlapMemory, places), stored)
    assert len(parts) == len(whole) == 20
    for query in views(6, 5):
        np.testing.assert_array_equal(parts.respond(query, rule), whole.respond(query, rule))


def test_a_segmented_memory_of_no_places_answers_nothing() -> None:
    memory = SegmentedMemory(OverlapMemory)
    assert len(memory) == 0
    assert memory.respond(views(0, 1)[0], Rule(0.2, 1.0, 3.0)).shape == (0,)


def test_codes_of_two_sizes_are_refused() -> None:
    memory = OverlapMemory()
    memory.add(View(np.ones((1, 3), np.float32), np.zeros(1, np.float32)))
    wide = View(np.ones((1, 4), np.float32), np.zeros(1, np.float32))
    for use in memory.add, lambda view: memory.respond(view, Rule(0.0, 1.0, 1.0)):
        with pytest.raises(PluginError, match="signatures of 4 values, the places stored have 3"):
            use(wide)
