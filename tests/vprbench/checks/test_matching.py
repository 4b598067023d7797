"""Every check of the faster ways to match fails for a wrong one, and passes for a good one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from vprbench.agents import build_encoder
from vprbench.checks import DoesNotApply, encoder_checks
from vprbench.protocols import Encoder
from vprbench.types import Frame, Landmarks

THIRD_PARTY = Path(__file__).parents[2] / "third_party"

Signatures = npt.NDArray[np.float32]
Indices = npt.NDArray[np.int64]


@pytest.fixture(autouse=True)
def acme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(THIRD_PARTY))


class Good:
    """An encoder of brightness, which compares pairs too."""

    def __init__(self) -> None:
        self.good = build_encoder("mean-patch")
        self.fit, self.encode = self.good.fit, self.good.encode

    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        return self.good.match(queries, memory)

    def match_pairs(self, queries: Signatures, memory: Signatures, p: Indices, m: Indices) -> Signatures:
        return np.float32(1) - np.abs(queries[p] - memory[m]).mean(axis=1)

    matches_by_sketch = True

    def sketch(self, signatures: Signatures) -> Signatures:
        return signatures.mean(axis=1, keepdims=True)

    def match_at_most(self, queries: Signatures, memory: Signatures, p: Indices, m: Indices) -> Signatures:
        return np.float32(1 + 1e-6) - np.abs(queries[p] - memory[m])[:, 0]


class TakesBytes(Good):
    """The same, also of bytes."""

    matches_bytes = True

    def match_pairs(self, queries: Signatures, memory: Signatures, p: Indices, m: Indices) -> Signatures:
        return super().match_pairs(self.values(queries), self.values(memory), p, m)

    def sketch(self, signatures: Signatures) -> Signatures:
        return super().sketch(self.values(signatures))

    def values(self, signatures: npt.NDArray[Any]) -> Signatures:
        return signatures.astype(np.float32) / np.float32(255 if signatures.dtype == np.uint8 else 1)


class TakesBytesForWhole(TakesBytes):
    matches_by_sketch = False

    def values(self, signatures: npt.NDArray[Any]) -> Signatures:
        return signatures.astype(np.float32)


class SketchesBytesAsTheyAre(TakesBytes):
    def sketch(self, signatures: Signatures) -> Signatures:
        return signatures.mean(axis=1, keepdims=True, dtype=np.float32)


class TakesBytesButIsAboveOne(TakesBytes):
    matches_by_sketch = False

    def __init__(self) -> None:
        super().__init__()
        self.encode = self.brighter

    def brighter(self, frame: Frame) -> Landmarks:
        signatures, points = self.good.encode(frame)
        return Landmarks(signatures + np.float32(1), points)


class SwapsTheIndices(Good):
    matches_by_sketch = False

    def match_pairs(self, queries: Signatures, memory: Signatures, p: Indices, m: Indices) -> Signatures:
        return super().match_pairs(queries, memory, m, p)


class ScalesByTheBest(Good):
    matches_by_sketch = False

    def match_pairs(self, queries: Signatures, memory: Signatures, p: Indices, m: Indices) -> Signatures:
        matches = super().match_pairs(queries, memory, p, m)
        return matches * np.float32(1 + 1e-7 * len(matches))


class BoundsTooTightly(Good):
    def match_at_most(self, queries: Signatures, memory: Signatures, p: Indices, m: Indices) -> Signatures:
        return super().match_at_most(queries, memory, p, m) - np.float32(0.01)


class FearsToSketchNothing(Good):
    def sketch(self, signatures: Signatures) -> Signatures:
        return super().sketch(signatures)[:, : len(signatures)]


class Overlaps(Good):
    """One value after another, as it is written down."""

    matches_by_overlap, matches_by_sketch = True, False

    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        matches = [[self.overlap(a, b) for b in memory] for a in queries]
        return np.array(matches, np.float32).reshape(len(queries), len(memory))

    def match_pairs(self, queries: Signatures, memory: Signatures, p: Indices, m: Indices) -> Signatures:
        return self.match(queries, memory)[p, m]

    def overlap(self, a: Signatures, b: Signatures) -> np.float32:
        common = one = other = np.float32(0)
        for x, y in zip(a, b, strict=True):
            common += min(abs(x), abs(y)) if x * y > 0 else np.float32(0)
            one, other = one + abs(x), other + abs(y)
        return np.float32(2) * common / (one + other) if one + other > 0 else np.float32(1)


class OverlapsRoughly(Overlaps):
    def overlap(self, a: Signatures, b: Signatures) -> np.float32:
        return np.float32(1) - np.abs(a - b).sum() / (np.abs(a) + np.abs(b)).sum() if (a - b).any() else np.float32(1)


class KnowsNoSign(Overlaps):
    def overlap(self, a: Signatures, b: Signatures) -> np.float32:
        return super().overlap(abs(a), abs(b))


class SharesNothingWhereThereIsNothing(Overlaps):
    def overlap(self, a: Signatures, b: Signatures) -> np.float32:
        return super().overlap(a, b) if a.any() else np.float32(0)


def failing(factory: Callable[[], Encoder]) -> set[str]:
    failed = set()
    for check in encoder_checks(factory):
        try:
            check.run()
        except DoesNotApply:
            continue
        except AssertionError:
            failed.add(check.name)
    return failed


@pytest.mark.parametrize("good", [Good, TakesBytes, Overlaps])
def test_good_ones_pass(good: Callable[[], Encoder]) -> None:
    assert failing(good) == set()


@pytest.mark.parametrize(
    ("wrong", "name"),
    [
        (SwapsTheIndices, "match-pairs-gives-what-match-gives"),
        (ScalesByTheBest, "match-pairs-gives-what-match-gives"),
        (BoundsTooTightly, "matches-at-most-what-sketches-say"),
        (FearsToSketchNothing, "matches-at-most-what-sketches-say"),
        (TakesBytesForWhole, "matches-bytes-if-it-says-so"),
        (SketchesBytesAsTheyAre, "matches-bytes-if-it-says-so"),
        (TakesBytesButIsAboveOne, "matches-bytes-if-it-says-so"),
        (OverlapsRoughly, "matches-by-overlap-if-it-says-so"),
        (KnowsNoSign, "matches-by-overlap-if-it-says-so"),
        (SharesNothingWhereThereIsNothing, "matches-by-overlap-if-it-says-so"),
    ],
)
def test_a_wrong_one_fails_its_check_and_no_other(wrong: Callable[[], Encoder], name: str) -> None:
    assert failing(wrong) == {name}


@pytest.mark.parametrize("name", ["log-polar-6", "log-polar"])
def test_ours_pass(name: str) -> None:
    assert failing(lambda: build_encoder(name)) == set()
