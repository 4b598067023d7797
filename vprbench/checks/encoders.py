"""What the protocol asks of an encoder, demand by demand."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from vprbench.checks.check import Check, Suite, expect
from vprbench.checks.encoder_subject import EncoderSubject, LazyFrames, same_landmarks
from vprbench.checks.learned import learned_suite
from vprbench.checks.matching import matching_suite
from vprbench.checks.samples import flat_frame, textured_frame, training_frames
from vprbench.plugins import missing
from vprbench.protocols import Encoder
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Landmarks

__all__ = ["encoder_checks"]

# Rounding that a match in float32 may show; a cosine of 3,000 values stays well below it.
ROUNDING = 1e-5


def encoder_checks(factory: Callable[[], Encoder]) -> Iterator[Check]:
    """Every check of an encoder; `factory` makes a new one, and always the same.

    The checks share one fitted encoder, so that an encoder that is slow to learn need not learn in each.
    """
    subject = EncoderSubject(factory)
    yield from _suite.checks(subject)
    yield from matching_suite.checks(subject)
    yield from learned_suite.checks(subject)


_suite = Suite[EncoderSubject]()


@_suite.add
def _has_every_method(subject: EncoderSubject) -> None:
    lacks = missing("encoder", subject.factory())
    expect(not lacks, f"an Encoder has fit, encode and match; this one lacks {', '.join(lacks)}")


@_suite.add
def _fit_accepts_any_sequence(subject: EncoderSubject) -> None:
    try:
        subject.fit(LazyFrames())
    except Exception as error:
        expect(False, f"fit takes any Sequence of frames, not lists only; it raised {error!r}")


@_suite.add
def _fit_is_repeatable(subject: EncoderSubject) -> None:
    again = subject.fit(training_frames()).encode(textured_frame(1))
    same = same_landmarks(again, subject.landmarks[0])
    expect(same, "the same seed and frames fit the same encoder: draw from the seed")


@_suite.add
def _gives_one_point_a_signature(subject: EncoderSubject) -> None:
    for signatures, points in subject.landmarks:
        asked = signatures.ndim == 2 and points.shape == (len(signatures), 2)
        expect(asked, f"signatures are (n, size) and points (n, 2), not {signatures.shape} and {points.shape}")


@_suite.add
def _gives_float32(subject: EncoderSubject) -> None:
    for signatures, points in subject.landmarks:
        kinds = {str(signatures.dtype), str(points.dtype)}
        expect(kinds == {"float32"}, f"signatures and points are float32, not {' and '.join(sorted(kinds))}")


@_suite.add
def _gives_finite_signatures(subject: EncoderSubject) -> None:
    for signatures, _ in subject.landmarks:
        expect(bool(np.isfinite(signatures).all()), "signatures are finite; these hold NaN or infinity")


@_suite.add
def _gives_contiguous_arrays(subject: EncoderSubject) -> None:
    for arrays in subject.landmarks:
        expect(all(a.flags.c_contiguous for a in arrays), "signatures and points are C-contiguous: copy what is a view")


@_suite.add
def _gives_points_inside_the_frame(subject: EncoderSubject) -> None:
    for _, points in subject.landmarks:
        inside = (points >= 0) & (points <= (FRAME_WIDTH - 1, FRAME_HEIGHT - 1))
        expect(bool(inside.all()), f"points are columns 0..{FRAME_WIDTH - 1} and rows 0..{FRAME_HEIGHT - 1}, in pixels")


@_suite.add
def _finds_landmarks_in_texture(subject: EncoderSubject) -> None:
    for signatures, _ in subject.landmarks:
        expect(len(signatures) > 0, "a frame full of texture gives at least one landmark")


@_suite.add
def _gives_signatures_of_one_size(subject: EncoderSubject) -> None:
    sizes = {landmarks.signatures.shape[-1] for landmarks in subject.landmarks}
    expect(len(sizes) == 1, f"signatures have one size whatever the frame, not {sorted(sizes)}")


@_suite.add
def _tells_frames_apart(subject: EncoderSubject) -> None:
    one, other = (landmarks.signatures for landmarks in subject.landmarks)
    expect(not np.array_equal(one, other), "frames that show different things give different signatures")


@_suite.add
def _accepts_a_uniform_frame(subject: EncoderSubject) -> None:
    size = subject.landmarks[0].signatures.shape[-1]
    for grey in (0, 128, 255):
        try:
            signatures, points = subject.encoder.encode(flat_frame(grey))
        except Exception as error:
            expect(False, f"a frame of one grey is encoded, if need be without landmarks; it raised {error!r}")
        asked = signatures.shape == (len(points), size) and bool(np.isfinite(signatures).all())
        expect(asked, f"a frame of one grey gives (n, {size}) finite signatures, n may be 0, not {signatures.shape}")


@_suite.add
def _encodes_repeatably(subject: EncoderSubject) -> None:
    again = subject.encoder.encode(textured_frame(1))
    same = same_landmarks(again, subject.landmarks[0])
    expect(same, "the same frame gives the same landmarks, whatever was encoded between")


@_suite.add
def _leaves_the_frame_alone(subject: EncoderSubject) -> None:
    frame = textured_frame(1)
    subject.encoder.encode(frame)
    expect(np.array_equal(frame, textured_frame(1)), "encode does not write into the frame")


@_suite.add
def _gives_landmarks_their_own_memory(subject: EncoderSubject) -> None:
    frame = textured_frame(1)
    landmarks = subject.encoder.encode(frame)
    before = Landmarks(landmarks.signatures.copy(), landmarks.points.copy())
    frame[:] = 0
    subject.encoder.encode(textured_frame(2))
    expect(same_landmarks(landmarks, before), "landmarks stay as they are when the frame changes or another is encoded")


@_suite.add
def _match_gives_float32_points_by_units(subject: EncoderSubject) -> None:
    one, other = subject.signatures
    for memory in (other, other[:1]):
        matches = subject.encoder.match(one, memory)
        asked = matches.shape == (len(one), len(memory)) and matches.dtype == np.float32
        expect(asked, f"match gives float32 {(len(one), len(memory))}, not {matches.dtype} {matches.shape}")


@_suite.add
def _match_accepts_no_landmarks(subject: EncoderSubject) -> None:
    some, _ = subject.signatures
    for queries, memory in ((some[:0], some), (some, some[:0]), (some[:0], some[:0])):
        shape = len(queries), len(memory)
        try:
            matches = subject.encoder.match(queries, memory)
        except Exception as error:
            expect(False, f"match of {shape[0]} queries and {shape[1]} units is empty; it raised {error!r}")
        expect(
            matches.shape == shape, f"match of {shape[0]} queries and {shape[1]} units is {shape}, not {matches.shape}"
        )


@_suite.add
def _match_lies_in_0_1(subject: EncoderSubject) -> None:
    one, other = subject.signatures
    matches = subject.encoder.match(one, other)
    asked = bool(((matches >= -ROUNDING) & (matches <= 1 + ROUNDING)).all())
    expect(asked, f"match lies in 0..1, not {matches.min(initial=0):g}..{matches.max(initial=1):g}")


@_suite.add
def _match_of_equals_is_1(subject: EncoderSubject) -> None:
    some, _ = subject.signatures
    away = float(np.abs(np.diag(subject.encoder.match(some, some)) - 1).max(initial=0))
    expect(away <= ROUNDING, f"a signature matches itself with 1; this one is {away:g} away from it")


@_suite.add
def _match_compares_pair_by_pair(subject: EncoderSubject) -> None:
    together = subject.encoder.match(*subject.signatures)
    one, other = subject.signatures
    apart = subject.encoder.match(one[:1], other[:1])
    asked = bool(np.allclose(together[:1, :1], apart, atol=ROUNDING))
    expect(asked, "the match of two signatures does not depend on which others are matched with them")


@_suite.add
def _match_leaves_its_arguments_alone(subject: EncoderSubject) -> None:
    one, other = subject.signatures
    subject.encoder.match(one, other)
    kept = [np.array_equal(now, was) for now, was in zip((one, other), subject.signatures, strict=True)]
    expect(all(kept), "match does not write into its arguments")
