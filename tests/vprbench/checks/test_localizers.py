"""Every check of a localizer fails for a wrong localizer, and passes for a good one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import count
from math import pi
from pathlib import Path
from typing import Any, ClassVar, cast

import numpy as np
import numpy.typing as npt
import pytest

from vprbench.agents import build
from vprbench.checks import DoesNotApply, localizer_checks
from vprbench.protocols import DescriptorLocalizer, Localizer, Recruiting
from vprbench.types import Hypothesis, Observation, Responses, hypothesis

THIRD_PARTY = Path(__file__).parents[2] / "third_party"


@pytest.fixture(autouse=True)
def acme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(THIRD_PARTY))


class Good:
    """Does what a good localizer does; each wrong one departs from it in a single thing."""

    recruiting: ClassVar[Recruiting] = "vigilance"

    def __init__(self) -> None:
        self.good = build({"localizer": "nearest-view", "encoder": "mean-patch"})
        self.encoder = self.good.encoder  # type: ignore[attr-defined]

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        self.good.fit(drives)

    def clear(self, sampling: float) -> None:
        self.good.clear(sampling)

    def learn(self, observation: Observation) -> int | None:
        return self.good.learn(observation)

    def respond(self, observation: Observation) -> Responses:
        return self.good.respond(observation)


class GoodDescriptor(Good):
    """The same, with descriptions."""

    good: DescriptorLocalizer[Any]

    def describe(self, observation: Observation) -> object:
        return self.good.describe(observation)

    def compare(self, queries: Sequence[object], places: Sequence[object]) -> npt.NDArray[np.float32]:
        return self.good.compare(queries, places)


class GoodStore(GoodDescriptor):
    """One that can also be given places outright."""

    def store(self, description: object) -> int:
        good: Any = self.good
        good.places.append(description)
        return len(good.places) - 1


class GoodStep(Good):
    """The same for one that recruits by road."""

    recruiting: ClassVar[Recruiting] = "step"

    def __init__(self) -> None:
        self.good = build("thumbnail")


class GoodLocator(GoodStep):
    """The same, with a shorter way to the best place."""

    def locate(self, observation: Observation) -> Hypothesis:
        return hypothesis(self.respond(observation))


class HasNoRespond:
    recruiting: ClassVar[Recruiting] = "vigilance"
    fit, clear, learn = Good.fit, Good.clear, Good.learn
    __init__ = Good.__init__


class RecruitsByMood(Good):
    recruiting = cast(Recruiting, "mood")


class FitsDifferentlyEachTime(Good):
    fits: ClassVar[Iterator[int]] = count(1)

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        self.scale = np.float32(1 / next(self.fits))

    def respond(self, observation: Observation) -> Responses:
        return super().respond(observation) * self.scale


class RefitsItsEncoder(Good):
    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        super().fit(drives)
        self.encoder.fit([observation["frame"] for drive in drives for observation in drive])


class FollowsItsEncodersLearning(Good):
    def __init__(self) -> None:
        self.good = build({"localizer": "nearest-view", "encoder": "typical"})
        self.encoder = self.good.encoder  # type: ignore[attr-defined]

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        super().fit(drives)
        list(self.encoder.learning([drives[0][0]["frame"]]))


class AnswersWithoutPlaces(Good):
    def respond(self, observation: Observation) -> Responses:
        responses = super().respond(observation)
        return responses if responses.size else np.zeros(1, np.float32)


class CountsFromOne(Good):
    def learn(self, observation: Observation) -> int | None:
        place = super().learn(observation)
        return None if place is None else place + 1


class CountsInNumpy(Good):
    def learn(self, observation: Observation) -> int | None:
        place = super().learn(observation)
        return None if place is None else cast(int, np.int64(place))


class RecruitsEverything(Good):
    def clear(self, sampling: float) -> None:
        super().clear(1.0)


class RecruitsOnceMoreThanAsked(GoodStep):
    def clear(self, sampling: float) -> None:
        super().clear(sampling / 2)


class MeasuresTheBeeline(GoodStep):
    def clear(self, sampling: float) -> None:
        super().clear(1e-9)
        self.step, self.origin = sampling, np.array([np.inf, np.inf])

    def learn(self, observation: Observation) -> int | None:
        here = observation["gps"].copy()
        if np.linalg.norm(here - self.origin) < self.step:
            return None
        self.origin = here
        return super().learn(observation)


class AddsAPlace(Good):
    def respond(self, observation: Observation) -> Responses:
        responses = super().respond(observation)
        return np.append(responses, responses[:1] * np.float32(0.5))


class RespondsInFloat64(Good):
    def respond(self, observation: Observation) -> Responses:
        return super().respond(observation).astype(np.float64)


class RespondsAbove1(Good):
    def respond(self, observation: Observation) -> Responses:
        return super().respond(observation) * np.float32(1.0001)


class MistakesEndForBeginning(Good):
    def respond(self, observation: Observation) -> Responses:
        return super().respond(observation)[::-1]


class Tires(Good):
    """Responds less when it has just seen a frame further on."""

    def clear(self, sampling: float) -> None:
        super().clear(sampling)
        self.last = 0.0

    def respond(self, observation: Observation) -> Responses:
        here = float(observation["gps"][0]) if "gps" in observation else self.last
        weight, self.last = (0.5 if self.last > here else 1), here
        return super().respond(observation) * np.float32(weight)


class LearnsWhenAsked(Good):
    def respond(self, observation: Observation) -> Responses:
        responses = super().respond(observation)
        if responses.size:
            self.learn(observation)
        return responses


class ReadsGps(Good):
    def respond(self, observation: Observation) -> Responses:
        assert np.isfinite(observation["gps"]).all()
        return super().respond(observation)


class UsesGpsWhereThereIs(Good):
    def respond(self, observation: Observation) -> Responses:
        return super().respond(observation) * np.float32(1.0 if "gps" in observation else 0.5)


class WritesIntoTheObservation(Good):
    def respond(self, observation: Observation) -> Responses:
        observation["camera"][0] += 1
        return super().respond(observation)


class KeepsTheCallersArrays(Good):
    def clear(self, sampling: float) -> None:
        super().clear(sampling)
        self.headings = [np.array([pi / 2])]

    def learn(self, observation: Observation) -> int | None:
        self.headings.append(observation["heading"])
        return super().learn(observation)

    def respond(self, observation: Observation) -> Responses:
        return super().respond(observation) * np.float32(np.mean(self.headings) / (pi / 2))


class FearsFog(Good):
    def respond(self, observation: Observation) -> Responses:
        if not observation["frame"].std():
            raise ZeroDivisionError("no contrast")
        return super().respond(observation)


class RespondsNanAfterFog(Good):
    fog = False

    def learn(self, observation: Observation) -> int | None:
        self.fog = not observation["frame"].std()
        return super().learn(observation)

    def respond(self, observation: Observation) -> Responses:
        return super().respond(observation) * np.float32(np.nan if self.fog else 1)


class Resents(Good):
    """Remembers, through clear, how many places it ever made."""

    made = 0

    def learn(self, observation: Observation) -> int | None:
        self.made += 1
        return super().learn(observation)

    def respond(self, observation: Observation) -> Responses:
        return super().respond(observation) * np.float32(1 / max(self.made, 1))


class ComparesPairsDifferently(GoodDescriptor):
    def compare(self, queries: Sequence[object], places: Sequence[object]) -> npt.NDArray[np.float32]:
        return super().compare(queries, places) * np.float32(0.5 if len(places) == 1 else 1)


class ComparesRoughly(GoodDescriptor):
    def compare(self, queries: Sequence[object], places: Sequence[object]) -> npt.NDArray[np.float32]:
        return np.nextafter(super().compare(queries, places), np.float32(0))


class LearnsAtAnotherVigilance(GoodDescriptor):
    def clear(self, sampling: float) -> None:
        super().clear(sampling**2)


class StoresOnlyWhatIsNew(GoodStore):
    def store(self, description: object) -> int:
        good: Any = self.good
        return super().store(description) if len(good.places) < 2 else 1


class StoresTheFirstOnly(GoodStore):
    def store(self, description: object) -> int:
        good: Any = self.good
        return super().store(good.places[0] if good.places else description)


class LocatesTheLast(GoodLocator):
    def locate(self, observation: Observation) -> Hypothesis:
        responses = self.respond(observation)
        place, confidence = super().locate(observation)
        return Hypothesis(max(np.flatnonzero(responses == confidence).tolist(), default=place), confidence)


class LocatesRoughly(GoodLocator):
    def locate(self, observation: Observation) -> Hypothesis:
        place, confidence = super().locate(observation)
        return Hypothesis(place, float(np.nextafter(np.float32(confidence), np.float32(0))))


class LocatesWithoutPlaces(GoodLocator):
    def locate(self, observation: Observation) -> Hypothesis:
        return Hypothesis(max(super().locate(observation).place, 0), super().locate(observation).confidence)


# The check that a wrong localizer is made for, and the further ones that catch it as well.
WRONG: list[tuple[str, Callable[[], Localizer], set[str]]] = [
    ("says-what-recruits", RecruitsByMood, {"recruits-as-often-as-asked"}),
    ("fit-is-repeatable", FitsDifferentlyEachTime, set()),
    ("leaves-its-encoder-as-it-is", RefitsItsEncoder, set()),
    ("leaves-its-encoder-as-it-is", FollowsItsEncodersLearning, set()),
    ("is-silent-without-places", AnswersWithoutPlaces, set()),
    ("numbers-places-in-order", CountsFromOne, set()),
    ("numbers-places-in-order", CountsInNumpy, set()),
    ("recruits-as-often-as-asked", RecruitsEverything, set()),
    ("recruits-as-often-as-asked", RecruitsOnceMoreThanAsked, set()),
    ("recruits-as-often-as-asked", MeasuresTheBeeline, set()),
    ("responds-once-a-place", AddsAPlace, set()),
    ("responds-in-float32", RespondsInFloat64, set()),
    ("responds-in-0-1", RespondsAbove1, set()),
    ("recognises-what-it-learned", MistakesEndForBeginning, set()),
    ("responds-repeatably", Tires, {"respond-learns-nothing"}),
    ("respond-learns-nothing", LearnsWhenAsked, {"places-have-their-own-memory"}),
    ("respond-needs-no-gps", ReadsGps, set()),
    ("respond-needs-no-gps", UsesGpsWhereThereIs, set()),
    ("leaves-the-observation-alone", WritesIntoTheObservation, set()),
    ("places-have-their-own-memory", KeepsTheCallersArrays, set()),
    ("accepts-a-uniform-frame", FearsFog, set()),
    ("accepts-a-uniform-frame", RespondsNanAfterFog, set()),
    ("clear-forgets", Resents, set()),
    ("respond-agrees-with-compare", ComparesPairsDifferently, set()),
    ("respond-agrees-with-compare", ComparesRoughly, set()),
    ("locate-agrees-with-respond", LocatesTheLast, set()),
    ("locate-agrees-with-respond", LocatesRoughly, set()),
    ("locate-agrees-with-respond", LocatesWithoutPlaces, set()),
    ("learn-agrees-with-compare", LearnsAtAnotherVigilance, set()),
    ("store-makes-places-outright", StoresOnlyWhatIsNew, set()),
    ("store-makes-places-outright", StoresTheFirstOnly, set()),
]


def failing(factory: Callable[[], Localizer]) -> set[str]:
    """Names of the checks that fail."""
    failed = set()
    for check in localizer_checks(factory):
        try:
            check.run()
        except DoesNotApply:
            continue
        except Exception:
            failed.add(check.name)
    return failed


@pytest.mark.parametrize("good", [Good, GoodDescriptor, GoodStore, GoodStep, GoodLocator])
def test_a_good_localizer_passes(good: Callable[[], Localizer]) -> None:
    assert failing(good) == set()


def test_every_check_has_its_wrong_localizer() -> None:
    assert {check.name for check in localizer_checks(Good)} == {name for name, _, _ in WRONG} | {"has-every-method"}


@pytest.mark.parametrize(("name", "wrong", "also"), WRONG)
def test_a_wrong_localizer_fails_its_check(name: str, wrong: Callable[[], Localizer], also: set[str]) -> None:
    assert failing(wrong) == {name, *also}


def test_a_localizer_without_a_method_is_told_which() -> None:
    first = next(localizer_checks(cast(Callable[[], Localizer], HasNoRespond)))
    with pytest.raises(AssertionError, match="this one lacks respond"):
        first.run()
