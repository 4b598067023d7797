"""What the protocol asks of a localizer, demand by demand."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from typing import Any, get_args
from unittest.mock import patch

import numpy as np
from jaxtyping import Float32

from vprbench.checks.check import Check, DoesNotApply, Suite, expect
from vprbench.checks.localizer_subject import LocalizerSubject, encoder_of
from vprbench.checks.samples import flat_frame, training_drives, training_frames
from vprbench.plugins import missing
from vprbench.protocols import DescriptorLocalizer, Localizer, Locating, Recruiting, Storing
from vprbench.types import Observation, hypothesis

__all__ = ["localizer_checks"]


def localizer_checks(factory: Callable[[], Localizer]) -> Iterator[Check]:
    """Every check of a localizer; `factory` makes a new one, and always the same.

    The checks share one fitted localizer, so that one that is slow to learn need not learn in each.
    """
    return _suite.checks(LocalizerSubject(factory))


_suite = Suite[LocalizerSubject]()


def _answers(localizer: Localizer, observations: Sequence[Observation]) -> Float32[np.ndarray, "queries places"]:
    return np.stack([localizer.respond(observation) for observation in observations])


def _blind(observation: Observation) -> Observation:
    return Observation(frame=observation["frame"], heading=observation["heading"], camera=observation["camera"])


@_suite.add
def _has_every_method(subject: LocalizerSubject) -> None:
    lacks = missing("localizer", subject.factory())
    asked = "a Localizer has recruiting, fit, clear, learn and respond"
    expect(not lacks, f"{asked}; this one lacks {', '.join(lacks)}")


@_suite.add
def _says_what_recruits(subject: LocalizerSubject) -> None:
    known, said = get_args(Recruiting), subject.factory().recruiting
    expect(said in known, f"recruiting is one of {', '.join(map(repr, known))}, not {said!r}")


@_suite.add
def _fit_is_repeatable(subject: LocalizerSubject) -> None:
    localizer, places = subject.learned()
    before = _answers(localizer, subject.drive)
    again = subject.fit()
    again.clear(1.0 if again.recruiting == "vigilance" else 0.5)
    for place in places:
        again.learn(place)
    same = np.array_equal(_answers(again, subject.drive), before)
    expect(same, "the same seed and drives fit the same localizer: draw from the seed")


@_suite.add
def _leaves_its_encoder_as_it_is(subject: LocalizerSubject) -> None:
    localizer = subject.factory()
    encoder = encoder_of(localizer)
    if encoder is None:
        raise DoesNotApply("it has no encoder, which is optional")
    encoder.fit(training_frames())
    with ExitStack() as stack:
        # The class is watched, since not every object takes new attributes.
        names = [name for name in ("fit", "learning") if hasattr(type(encoder), name)]
        watched = [stack.enter_context(patch.object(type(encoder), name)) for name in names]
        localizer.fit(training_drives())
    asked = "the encoder is fitted before: fit what is the localizer's own, not the encoder"
    expect(not any(method.called for method in watched), asked)


@_suite.add
def _is_silent_without_places(subject: LocalizerSubject) -> None:
    responses = subject.cleared().respond(subject.unseen)
    expect(
        responses.shape == (0,),
        f"without places, at first and after clear, respond gives shape (0,), not {responses.shape}",
    )


@_suite.add
def _numbers_places_in_order(subject: LocalizerSubject) -> None:
    localizer = subject.cleared()
    given = [localizer.learn(seen) for seen in subject.drive for _ in range(2)]
    places = [place for place in given if place is not None]
    asked = all(type(place) is int for place in places) and places == list(range(len(places)))
    expect(asked, f"learn gives the ints 0, 1, ... to new places and None otherwise, not {given!r}")


@_suite.add
def _recruits_as_often_as_asked(subject: LocalizerSubject) -> None:
    if subject.fitted.recruiting == "step":
        asked, sparse, places = "step 2 recruits every 2 m of road, however it bends", 2.0, [0, 2, 4]
    else:
        asked, sparse, places = "vigilance 0 recruits the first frame, and no other", 0.0, [0]
    localizer = subject.cleared(sparse)
    recruited = [index for index, seen in enumerate(subject.bend) if localizer.learn(seen) is not None]
    expect(recruited == places, f"{asked}; of frames 1 m apart {recruited} were recruited")
    _, every = subject.learned()
    expect(len(every) == len(subject.drive), "vigilance 1, or a step below the spacing, recruits every new view")


@_suite.add
def _responds_once_a_place(subject: LocalizerSubject) -> None:
    localizer, places = subject.learned()
    shape = localizer.respond(subject.unseen).shape
    expect(shape == (len(places),), f"with {len(places)} places respond gives shape ({len(places)},), not {shape}")


@_suite.add
def _responds_in_float32(subject: LocalizerSubject) -> None:
    localizer, _ = subject.learned()
    dtype = localizer.respond(subject.unseen).dtype
    expect(dtype == np.float32, f"responses are float32, not {dtype}")


@_suite.add
def _responds_in_0_1(subject: LocalizerSubject) -> None:
    localizer, _ = subject.learned()
    responses = _answers(localizer, [*subject.drive, subject.unseen])
    asked = bool(((responses >= 0) & (responses <= 1)).all())
    expect(asked, f"responses lie in 0..1, not {responses.min():g}..{responses.max():g}: clip what rounding adds")


@_suite.add
def _recognises_what_it_learned(subject: LocalizerSubject) -> None:
    localizer, places = subject.learned()
    for index, responses in enumerate(_answers(localizer, places)):
        best = responses.argmax()
        asked = responses[index] == responses[best]
        expect(asked, f"no place responds more to a learned frame than its own; place {best} beat place {index}")


@_suite.add
def _responds_repeatably(subject: LocalizerSubject) -> None:
    localizer, places = subject.learned()
    same = np.array_equal(_answers(localizer, places), _answers(localizer, places[::-1])[::-1])
    expect(same, "the same observation gives the same responses, whatever was asked between")


@_suite.add
def _respond_learns_nothing(subject: LocalizerSubject) -> None:
    localizer, places = subject.learned()
    before = localizer.respond(places[0])
    localizer.respond(subject.unseen)
    expect(np.array_equal(localizer.respond(places[0]), before), "respond learns nothing, not even from a new view")


@_suite.add
def _respond_needs_no_gps(subject: LocalizerSubject) -> None:
    localizer, places = subject.learned()
    for place in places:
        seeing = localizer.respond(place)
        try:
            blind = localizer.respond(_blind(place))
        except Exception as error:
            expect(False, f"respond does without gps, which is there only while learning; it raised {error!r}")
        expect(np.array_equal(seeing, blind), "responses do not depend on gps, which is there only while learning")


@_suite.add
def _leaves_the_observation_alone(subject: LocalizerSubject) -> None:
    localizer, seen = subject.cleared(), subject.drive
    for observation in seen:
        localizer.learn(observation)
        localizer.respond(observation)
    same = all(map(_same, seen, subject.drive))
    expect(same, "learn and respond do not write into the observation")


def _same(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    return one.keys() == other.keys() and all(np.array_equal(one[key], other[key]) for key in one)


@_suite.add
def _places_have_their_own_memory(subject: LocalizerSubject) -> None:
    localizer, places = subject.learned()
    before = localizer.respond(subject.unseen)
    for place in places:
        for array in (place["frame"], place["heading"], place["camera"], place["gps"]):
            array[:] = 1
    same = np.array_equal(localizer.respond(subject.unseen), before)
    expect(same, "places stay as they are when the arrays of an observation change later: copy what is kept")


@_suite.add
def _accepts_a_uniform_frame(subject: LocalizerSubject) -> None:
    for grey in (0, 128, 255):
        flat = Observation(**{**subject.unseen, "frame": flat_frame(grey)})
        localizer, places = subject.learned()
        try:
            localizer.respond(flat)
            localizer.learn(flat)
            responses = localizer.respond(places[0])
        except Exception as error:
            expect(False, f"a frame of one grey is learned and answered like any other; it raised {error!r}")
        expect(bool(np.isfinite(responses).all()), "responses are finite also where a place is a frame of one grey")


@_suite.add
def _clear_forgets(subject: LocalizerSubject) -> None:
    localizer, _ = subject.learned()
    before = _answers(localizer, subject.drive)
    again, _ = subject.learned()
    same = np.array_equal(_answers(again, subject.drive), before)
    expect(same, "after clear nothing is left: the same drive gives the same places and responses")


def _descriptor(subject: LocalizerSubject) -> DescriptorLocalizer[Any]:
    """The fitted localizer, if it has what only some have."""
    if not isinstance(subject.fitted, DescriptorLocalizer):
        raise DoesNotApply("it has no describe and compare, which are optional")
    return subject.fitted


@_suite.add
def _respond_agrees_with_compare(subject: LocalizerSubject) -> None:
    localizer, places = _descriptor(subject), subject.learned()[1]
    streamed = _answers(localizer, places)
    described = [localizer.describe(_blind(place)) for place in places]
    asked = "compare gives exactly what respond gives"
    expect(np.array_equal(localizer.compare(described, described), streamed), f"{asked}, for all frames at once")
    pairs = [[localizer.compare([query], [place])[0, 0] for place in described] for query in described]
    expect(np.array_equal(np.array(pairs, np.float32), streamed), f"{asked}, also pair by pair")


@_suite.add
def _learn_agrees_with_compare(subject: LocalizerSubject) -> None:
    localizer, places = _descriptor(subject), subject.learned()[1]
    if localizer.recruiting != "vigilance":
        raise DoesNotApply("it recruits by road, whatever the responses")
    described = [localizer.describe(_blind(place)) for place in places]
    matrix = localizer.compare(described, described)
    for vigilance in np.unique(matrix):
        recruits: list[int] = []
        for frame in range(len(places)):
            if not recruits or matrix[frame, recruits].max() < vigilance:
                recruits.append(frame)
        localizer.clear(float(vigilance))
        learned = [frame for frame, place in enumerate(places) if localizer.learn(place) is not None]
        asked = "learn recruits exactly where the best response that compare gives is below the vigilance"
        expect(learned == recruits, f"{asked}: at {vigilance:g} frames {recruits}, not {learned}")


@_suite.add
def _store_makes_places_outright(subject: LocalizerSubject) -> None:
    if not isinstance(subject.fitted, Storing):
        raise DoesNotApply("it has no store, which is optional")
    _, places = subject.learned()
    answers = _answers(subject.fitted, places)
    sparse = 0.0 if subject.fitted.recruiting == "vigilance" else 1e3
    subject.fitted.clear(sparse)
    made = [subject.fitted.store(subject.fitted.describe(place)) for place in places]
    expect(made == list(range(len(places))), f"store makes a place of all that it is given: 0, 1, ..., not {made!r}")
    same = np.array_equal(_answers(subject.fitted, places), answers)
    expect(same, "places that are stored respond as those that are learned")


@_suite.add
def _locate_agrees_with_respond(subject: LocalizerSubject) -> None:
    localizer = subject.cleared()
    if not isinstance(localizer, Locating):
        raise DoesNotApply("it has no locate, which is optional")
    # The same views elsewhere: one that recruits by road makes places of them that respond alike.
    again = [Observation(**{**seen, "gps": seen["gps"] + 100.0}) for seen in subject.drive]
    for learned in ([], subject.drive, again):
        for seen in learned:
            localizer.learn(seen)
        for asked in map(_blind, [*subject.drive, subject.unseen]):
            found, meant = localizer.locate(asked), hypothesis(localizer.respond(asked))
            expect(tuple(found) == meant, f"locate gives {tuple(meant)}, as respond has it, not {found!r}")
