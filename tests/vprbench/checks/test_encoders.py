"""Every check of an encoder fails for a wrong encoder that no other check catches, and passes for a good one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import count
from pathlib import Path
from typing import ClassVar, cast

import numpy as np
import numpy.typing as npt
import pytest

from vprbench.agents import build_encoder
from vprbench.checks import DoesNotApply, encoder_checks
from vprbench.checks.samples import textured_frame
from vprbench.protocols import Encoder
from vprbench.types import Frame, Landmarks

THIRD_PARTY = Path(__file__).parents[2] / "third_party"

Signatures = npt.NDArray[np.float32]


@pytest.fixture(autouse=True)
def acme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(THIRD_PARTY))


class Good:
    """Does what a good encoder does; each wrong one departs from it in a single thing."""

    def __init__(self) -> None:
        self.good = build_encoder("mean-patch")

    def fit(self, frames: Sequence[Frame]) -> None:
        self.good.fit(frames)

    def encode(self, frame: Frame) -> Landmarks:
        return self.good.encode(frame)

    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        return self.good.match(queries, memory)


def is_textured(frame: Frame) -> bool:
    return bool(frame.std() > 0)


def is_second(frame: Frame) -> bool:
    return np.array_equal(frame, textured_frame(2))


class HasNoMatch:
    def fit(self, frames: Sequence[Frame]) -> None:
        """Nothing to learn."""

    def encode(self, frame: Frame) -> Landmarks:
        return build_encoder("mean-patch").encode(frame)


class WantsList(Good):
    def fit(self, frames: Sequence[Frame]) -> None:
        if not isinstance(frames, list):
            raise TypeError("a list, please")


class FitsDifferentlyEachTime(Good):
    fits: ClassVar[Iterator[int]] = count(1)

    def fit(self, frames: Sequence[Frame]) -> None:
        self.scale = np.float32(1 / next(self.fits))

    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        return Landmarks(signatures * self.scale, points)


class ForgetsAPoint(Good):
    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        return Landmarks(signatures, points[1:] if is_textured(frame) else points)


class GivesFloat64(Good):
    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        return Landmarks(signatures, points.astype(np.float64))


class GivesInfinity(Good):
    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        signatures[0, 0] = np.inf if is_textured(frame) else 0
        return Landmarks(signatures, points)

    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        return super().match(np.minimum(queries, 1), np.minimum(memory, 1))


class GivesAView(Good):
    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        return Landmarks(signatures, np.asfortranarray(points))


class PointsOutside(Good):
    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        return Landmarks(signatures, points + 100)


class FindsNothingInOneFrame(Good):
    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        found = 0 if is_second(frame) else len(points)
        return Landmarks(signatures[:found], points[:found])


class ChangesItsSize(Good):
    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        return Landmarks(signatures[:, :8].copy() if is_second(frame) else signatures, points)

    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        return super().match(queries[:, :8], memory[:, :8])


class SeesTheSameEverywhere(Good):
    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        return Landmarks(np.full_like(signatures, 0.5), points)


class FearsFog(Good):
    def encode(self, frame: Frame) -> Landmarks:
        if not is_textured(frame):
            raise ZeroDivisionError("no contrast")
        return super().encode(frame)


class Drifts(Good):
    calls = 0

    def encode(self, frame: Frame) -> Landmarks:
        signatures, points = super().encode(frame)
        self.calls += 1
        return Landmarks(signatures * np.float32(1 / self.calls), points)


class WritesIntoTheFrame(Good):
    def encode(self, frame: Frame) -> Landmarks:
        landmarks = super().encode(frame)
        frame[0, 0] ^= 1
        return landmarks


class KeepsAViewOfTheFrame(Good):
    """As if the signatures were a view: they are lost with the frame they were made of."""

    last: tuple[Frame, Frame, Landmarks] | None = None

    def encode(self, frame: Frame) -> Landmarks:
        if self.last is not None and not np.array_equal(self.last[0], self.last[1]):
            self.last[2].signatures[:] = 0
        landmarks = super().encode(frame)
        self.last = frame, frame.copy(), landmarks
        return landmarks


class MatchesInFloat64(Good):
    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        return np.asarray(super().match(queries, memory), np.float64)


class FearsEmptiness(Good):
    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        matches = super().match(queries, memory)
        assert matches.max() <= 1
        return matches


class MatchesBelow0(Good):
    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        return np.asarray(1 - 20 * (1 - super().match(queries, memory)), np.float32)


class MatchesItselfByHalf(Good):
    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        return np.float32(0.5) * super().match(queries, memory)


class ScalesByTheBest(Good):
    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        matches = super().match(queries, memory)
        return matches / matches.max(initial=1e-9)


class WritesIntoTheQueries(Good):
    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        matches = super().match(queries, memory)
        queries[:] = 0
        return matches


WRONG: dict[str, Callable[[], Encoder]] = {
    "has-every-method": cast(Callable[[], Encoder], HasNoMatch),
    "fit-accepts-any-sequence": WantsList,
    "fit-is-repeatable": FitsDifferentlyEachTime,
    "gives-one-point-a-signature": ForgetsAPoint,
    "gives-float32": GivesFloat64,
    "gives-finite-signatures": GivesInfinity,
    "gives-contiguous-arrays": GivesAView,
    "gives-points-inside-the-frame": PointsOutside,
    "finds-landmarks-in-texture": FindsNothingInOneFrame,
    "gives-signatures-of-one-size": ChangesItsSize,
    "tells-frames-apart": SeesTheSameEverywhere,
    "accepts-a-uniform-frame": FearsFog,
    "encodes-repeatably": Drifts,
    "leaves-the-frame-alone": WritesIntoTheFrame,
    "gives-landmarks-their-own-memory": KeepsAViewOfTheFrame,
    "match-gives-float32-points-by-units": MatchesInFloat64,
    "match-accepts-no-landmarks": FearsEmptiness,
    "match-lies-in-0-1": MatchesBelow0,
    "match-of-equals-is-1": MatchesItselfByHalf,
    "match-compares-pair-by-pair": ScalesByTheBest,
    "match-leaves-its-arguments-alone": WritesIntoTheQueries,
}


def failing(factory: Callable[[], Encoder]) -> set[str]:
    """Names of the checks that fail."""
    failed = set()
    for check in encoder_checks(factory):
        try:
            check.run()
        except DoesNotApply:
            continue
        except Exception:
            failed.add(check.name)
    return failed


def test_a_good_encoder_passes() -> None:
    assert failing(Good) == set()


def test_every_check_has_its_wrong_encoder() -> None:
    # The eight that follow are about what is optional; see test_matching.py and test_learned.py.
    assert [check.name for check in encoder_checks(Good)][:-8] == list(WRONG)


@pytest.mark.parametrize("name", list(WRONG)[1:])
def test_a_wrong_encoder_fails_its_check_and_no_other(name: str) -> None:
    assert failing(WRONG[name]) == {name}


def test_an_encoder_without_a_method_fails_wherever_it_is_needed() -> None:
    assert failing(WRONG["has-every-method"]) == {name for name in WRONG if "match" in name} | {"has-every-method"}
