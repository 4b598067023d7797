"""Max-Pi in a world written down by hand: each frame is a number, each number a set of landmarks."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, inf, pi, radians

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jaxtyping import Float32, Int64

from vprbench.errors import ConfigError, PluginError
from vprbench.recruiting import recruit_by_vigilance
from vprbench.types import Frame, Landmarks, Observation
from vprbench_encoders.log_polar import LogPolar
from vprbench_localizers.azimuth import azimuths
from vprbench_localizers.matching import PairEncoder
from vprbench_localizers.max_pi import MaxPi
from vprbench_localizers.pair_memory import TOGETHER
from vprbench_localizers.unit_activity import View

Matrix = Float32[np.ndarray, "rows columns"]


class TableEncoder:
    """An encoder that looks its landmarks up; it only has what the protocol asks for."""

    def __init__(self, table: Sequence[Landmarks]) -> None:
        self.table = table

    def fit(self, frames: Sequence[Frame]) -> None: ...

    def encode(self, frame: Frame) -> Landmarks:
        return self.table[int(frame[0, 0])]

    def match(self, queries: Matrix, memory: Matrix) -> Matrix:
        distance: Matrix = np.abs(queries[:, None] - memory[None]).mean(axis=2)
        return 1 - distance


class PairTableEncoder(TableEncoder):
    """The same, able to compare chosen pairs."""

    def match_pairs(
        self, queries: Matrix, memory: Matrix, p: Int64[np.ndarray, " pairs"], m: Int64[np.ndarray, " pairs"]
    ) -> Float32[np.ndarray, " pairs"]:
        distance: Float32[np.ndarray, " pairs"] = np.abs(queries[p] - memory[m]).mean(axis=1)
        return 1 - distance


ENCODERS = pytest.mark.parametrize("encoder_class", [TableEncoder, PairTableEncoder])


def observe(number: int, heading: float = 0.0) -> Observation:
    frame = np.full((188, 642), number, np.uint8)
    return Observation(frame=frame, heading=np.array([heading]), camera=np.array([372.0, 314.0]))


def levels(*values: float) -> list[Landmarks]:
    """Frames of one landmark each, in the middle column; two frames match by 1 - |difference|."""
    middle = np.array([[314.0, 90.0]], np.float32)
    return [Landmarks(np.array([[value]], np.float32), middle) for value in values]


def random_table(seed: int, frames: int) -> list[Landmarks]:
    """Frames of up to 6 random landmarks; frame 0 has none."""
    rng = np.random.default_rng(seed)
    return [
        Landmarks(rng.random((n, 8), np.float32), (rng.random((n, 2)) * [642, 188]).astype(np.float32))
        for n in [0, *rng.integers(0, 7, frames - 1)]
    ]


def drive(seed: int, frames: int) -> list[Observation]:
    """Frames 0, 1, ... of a table, turning through all headings."""
    headings = np.random.default_rng(seed).uniform(-pi, pi, frames) / 4 + pi
    return [observe(i, (h + pi) % (2 * pi) - pi) for i, h in enumerate(headings)]


def from_the_equations(query: View, place: View, threshold: float, width: float, reach: float) -> float:
    """The response of a place to a query, unit by unit, landmark by landmark."""
    activities = []
    for w, theta in zip(place.signatures.astype(float), place.azimuths.astype(float), strict=True):
        best = 0.0
        for x, phi in zip(query.signatures.astype(float), query.azimuths.astype(float), strict=True):
            turn = abs((phi - theta + pi) % (2 * pi) - pi)
            recognised = max(0.0, 1 - abs(x - w).mean() - threshold) / (1 - threshold)
            if turn <= reach:
                best = max(best, recognised * exp(-(turn**2) / (2 * width**2)))
        activities.append(best)
    return sum(activities) / len(activities) if activities else 0.0


@ENCODERS
@settings(max_examples=15, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    threshold=st.floats(0.0, 0.9),
    width=st.floats(1.0, 60.0),
    widths=st.floats(0.5, 4.0),
)
def test_responses_follow_the_equations(
    encoder_class: type[TableEncoder], seed: int, threshold: float, width: float, widths: float
) -> None:
    encoder = encoder_class(random_table(seed, 7))
    agent = MaxPi(encoder, recognition_threshold=threshold, azimuth_width_deg=width, azimuth_reach=widths)
    views = [agent.describe(observation) for observation in drive(seed, 7)]
    expected = [
        [from_the_equations(q, p, threshold, radians(width), radians(width * widths)) for p in views] for q in views
    ]
    np.testing.assert_allclose(agent.compare(views, views), expected, atol=2e-5)


def bit_by_bit(query: View, place: View, matches: Matrix, threshold: float, width: float, reach: float) -> np.float32:
    """The same in the arithmetic of the product: float32, but for the agreement, with units summed in their order."""
    total, scale = np.float32(0), np.float32(1) - np.float32(threshold)
    for m, theta in enumerate(place.azimuths):
        best = np.float32(0)
        for p, phi in enumerate(query.azimuths):
            turn = float(abs(phi - theta))
            turn = abs(turn - 2 * float(np.float32(pi))) if turn > np.float32(pi) else turn
            recognised = min((matches[p, m] - np.float32(threshold)) / scale, np.float32(1))
            if turn <= reach and recognised > 0:
                best = max(best, recognised * np.float32(exp(-0.5 * (turn / width) ** 2)))
        total += best
    return total / np.float32(len(place.azimuths))


@pytest.mark.parametrize("threshold", [0.7, 0.8, 0.9])
def test_responses_equal_the_plain_formula_bitwise(threshold: float) -> None:
    """Of maps that match from 0.5 to 1: every threshold has pairs on either side. More places than a block holds."""
    rng = np.random.default_rng(1)
    base = cv2.GaussianBlur(rng.random((54, 54 * 40), np.float32), (0, 0), 3)
    base = (base - base.min()) / (base.max() - base.min())
    maps = np.stack([base[:, 9 * i : 9 * i + 54].ravel() for i in range(200)])
    table = [
        Landmarks(maps[rng.integers(0, 200, 6)], (rng.random((6, 2)) * [642, 188]).astype(np.float32))
        for _ in range(2 * TOGETHER + 3)
    ]
    encoder = LogPolar()
    agent = MaxPi(encoder, recognition_threshold=threshold, azimuth_width_deg=20.0)
    views = [
        View(signatures, azimuths(points[:, 0], heading, np.array([372.0, 314.0])))
        for (signatures, points), heading in zip(table, rng.uniform(-pi, pi, len(table)), strict=True)
    ]
    expected = [
        [
            bit_by_bit(q, p, encoder.match(q.signatures, p.signatures), threshold, radians(20.0), 3.0 * radians(20.0))
            for p in views
        ]
        for q in views[:4]
    ]
    found = agent.compare(views[:4], views)
    np.testing.assert_array_equal(found, np.array(expected, np.float32))
    assert 0 < np.count_nonzero(found) < found.size


@ENCODERS
@pytest.mark.parametrize("vigilance", [0.0, 0.1, 0.4, 1.0])
def test_streaming_equals_the_matrix_bitwise(encoder_class: type[TableEncoder], vigilance: float) -> None:
    # More frames than `compare` takes at a time.
    frames = drive(3, 90)
    agent = MaxPi(encoder_class(random_table(3, 90)), recognition_threshold=0.6, azimuth_width_deg=20.0)
    views = [agent.describe(frame) for frame in frames]
    matrix = agent.compare(views, views)
    agent.clear(vigilance)
    places = [index for index, frame in enumerate(frames) if agent.learn(frame) is not None]
    assert places == list(recruit_by_vigilance(lambda k: matrix[:, k], len(frames), vigilance))
    np.testing.assert_array_equal([agent.respond(frame) for frame in frames], matrix[:, places])


def test_streaming_equals_the_matrix_bitwise_with_log_polar() -> None:
    rng = np.random.default_rng(0)
    frames = [observe(0) for _ in range(6)]
    for frame in frames:
        frame["frame"][:] = np.kron(rng.integers(0, 256, (47, 214)), np.ones((4, 3)))
    agent = MaxPi(LogPolar(), recognition_threshold=0.5, vigilance=1.0)
    views = [agent.describe(frame) for frame in frames]
    matrix = agent.compare(views, views)
    assert [agent.learn(frame) for frame in frames] == [0, 1, 2, 3, 4, 5]
    np.testing.assert_array_equal([agent.respond(frame) for frame in frames], matrix)
    np.testing.assert_array_equal(matrix.diagonal(), 1.0)
    assert 0 < matrix[0, 1] < 1


def test_streaming_equals_the_matrix_bitwise_with_matrix_products() -> None:
    class Cosine(TableEncoder):
        def match(self, queries: Matrix, memory: Matrix) -> Matrix:
            return (queries @ memory.T) / np.outer(*(np.linalg.norm(m, axis=1) for m in (queries, memory)))

    rng = np.random.default_rng(0)
    points = np.full((25, 2), 314, np.float32)
    encoder = Cosine([Landmarks(rng.random((25, 225), np.float32), points) for _ in range(20)])
    agent = MaxPi(encoder, recognition_threshold=0.5, vigilance=1.0)
    frames = drive(0, 20)
    views = [agent.describe(frame) for frame in frames]
    streamed = []
    for frame in frames:
        agent.learn(frame)
        streamed.append(agent.respond(frame))
    for row, responses in zip(agent.compare(views, views), streamed, strict=True):
        np.testing.assert_array_equal(responses, row[: len(responses)])


def test_an_encoder_that_compares_pairs_is_never_asked_for_all() -> None:
    class Only(PairTableEncoder):
        def match(self, queries: Matrix, memory: Matrix) -> Matrix:
            raise AssertionError

    agent = MaxPi(Only(levels(0.0)), recognition_threshold=0.5)
    agent.learn(observe(0))
    assert agent.respond(observe(0)).tolist() == [1.0]


def test_a_place_recruits_where_no_place_responds_as_strongly_as_the_vigilance() -> None:
    agent = MaxPi(TableEncoder(levels(0.0, 0.1, 0.3, 0.35, 0.05)), vigilance=0.85, recognition_threshold=0.0)
    assert [agent.learn(observe(i)) for i in range(5)] == [0, None, 1, None, None]
    np.testing.assert_allclose(agent.respond(observe(1)), [0.9, 0.8], rtol=1e-6)


def test_a_response_equal_to_the_vigilance_does_not_recruit() -> None:
    agent = MaxPi(TableEncoder(levels(0.0, 0.5)), vigilance=0.5, recognition_threshold=0.0)
    assert [agent.learn(observe(i)) for i in range(2)] == [0, None]


@pytest.mark.parametrize(("vigilance", "places"), [(0.0, [0, None, None]), (1.0, [0, 1, None])])
def test_no_vigilance_keeps_one_place_and_full_vigilance_every_new_frame(
    vigilance: float, places: list[int | None]
) -> None:
    agent = MaxPi(TableEncoder(levels(0.2, 0.9)), vigilance=vigilance, recognition_threshold=0.0)
    assert [agent.learn(observe(i)) for i in (0, 1, 0)] == places


def test_the_recognition_ramp_starts_at_the_threshold() -> None:
    agent = MaxPi(TableEncoder(levels(0.0, 0.1, 0.2, 0.3)), recognition_threshold=0.8)
    agent.learn(observe(0))
    responses = [float(agent.respond(observe(i))[0]) for i in range(4)]
    np.testing.assert_allclose(responses, [1.0, 0.5, 0.0, 0.0], atol=1e-6)


def test_turning_away_silences_a_place_unless_azimuths_play_no_part() -> None:
    encoder = TableEncoder(levels(0.0))
    for width, reach, turned in (5.0, 3.0, 0.0), (5.0, 5.0, exp(-8.0)), (None, 3.0, 1.0), (inf, 3.0, 1.0):
        agent = MaxPi(encoder, recognition_threshold=0.5, azimuth_width_deg=width, azimuth_reach=reach)
        agent.learn(observe(0))
        assert agent.respond(observe(0, radians(20.0)))[0] == pytest.approx(turned, rel=1e-4)


def test_frames_without_landmarks_are_places_that_never_respond() -> None:
    nothing = Landmarks(np.empty((0, 1), np.float32), np.empty((0, 2), np.float32))
    agent = MaxPi(TableEncoder([nothing, *levels(0.0)]), vigilance=0.5, recognition_threshold=0.5)
    assert agent.respond(observe(0)).shape == (0,)
    assert [agent.learn(observe(i)) for i in (0, 1, 0, 1)] == [0, 1, 2, None]
    assert agent.respond(observe(1)).tolist() == [0.0, 1.0, 0.0]
    assert agent.respond(observe(0)).tolist() == [0.0, 0.0, 0.0]
    assert agent.compare([], [agent.describe(observe(0))]).shape == (0, 1)
    assert agent.compare([agent.describe(observe(0))], []).shape == (1, 0)


def test_a_match_above_one_does_not_respond_above_one() -> None:
    class Eager(TableEncoder):
        def match(self, queries: Matrix, memory: Matrix) -> Matrix:
            return super().match(queries, memory) + np.float32(0.2)

    agent = MaxPi(Eager(levels(0.0)), recognition_threshold=0.5)
    agent.learn(observe(0))
    assert agent.respond(observe(0)).tolist() == [1.0]


def test_clear_forgets_places_and_sets_the_vigilance() -> None:
    agent = MaxPi(TableEncoder(levels(0.0, 0.4)), vigilance=1.0, recognition_threshold=0.0)
    assert [agent.learn(observe(i)) for i in range(2)] == [0, 1]
    agent.clear(0.5)
    assert agent.respond(observe(0)).shape == (0,)
    assert [agent.learn(observe(i)) for i in range(2)] == [0, None]


def test_signatures_of_two_sizes_are_refused() -> None:
    wide = Landmarks(np.ones((1, 2), np.float32), np.ones((1, 2), np.float32))
    agent = MaxPi(PairTableEncoder([*levels(0.0), wide]), recognition_threshold=0.0)
    views = [agent.describe(observe(i)) for i in range(2)]
    with pytest.raises(PluginError, match="2 values, the places stored have 1"):
        agent.compare(views, views)


def test_without_a_threshold_it_asks_for_one() -> None:
    agent = MaxPi(TableEncoder(levels(0.0)))
    for use in agent.learn, agent.respond:
        with pytest.raises(ConfigError, match="no recognition threshold: call fit"):
            use(observe(0))


def test_the_encoders_here_do_and_do_not_compare_pairs() -> None:
    assert isinstance(PairTableEncoder([]), PairEncoder)
    assert not isinstance(TableEncoder([]), PairEncoder)
