"""What is asked of the faster ways to match that an encoder may offer: they give what `match` gives."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vprbench.checks.check import DoesNotApply, Suite, expect
from vprbench.checks.encoder_subject import EncoderSubject

__all__ = ["matching_suite"]

# A kernel of its own may add up in another order than the matrix product of `match`.
ROUNDING = 1e-5

matching_suite = Suite[EncoderSubject]()


def _offered(subject: EncoderSubject, name: str) -> Callable[..., Any]:
    """A method that only some encoders have."""
    method: Callable[..., Any] | None = getattr(subject.encoder, name, None)
    if method is None:
        raise DoesNotApply(f"it has no {name}, which is optional")
    return method


def _pairs(subject: EncoderSubject) -> tuple[tuple[NDArray[Any], ...], NDArray[np.float32]]:
    """Signatures and the indices of pairs, some of them listed twice, and how alike they are."""
    one, other = subject.signatures
    rng = np.random.default_rng(0)
    p, m = rng.integers(0, len(one), 300), rng.integers(0, len(other), 300)
    return (one, other, p, m), subject.encoder.match(one, other)[p, m]


@matching_suite.add
def _match_pairs_gives_what_match_gives(subject: EncoderSubject) -> None:
    compare = _offered(subject, "match_pairs")
    pairs, matches = _pairs(subject)
    found = compare(*pairs)
    asked = found.dtype == np.float32 and np.allclose(found, matches, atol=ROUNDING)
    expect(asked, "match_pairs gives float32 match(queries, memory)[query_index, memory_index]")
    one, other, p, m = pairs
    alone = compare(one, other, p[:1], m[:1])
    expect(np.array_equal(alone, found[:1]), "a pair has the same match, to the bit, whichever pairs stand beside it")


@matching_suite.add
def _matches_at_most_what_sketches_say(subject: EncoderSubject) -> None:
    if not getattr(subject.encoder, "matches_by_sketch", False):
        raise DoesNotApply("it does not say that it matches by sketch, which is optional")
    sketch, bound, exact = (_offered(subject, name) for name in ("sketch", "match_at_most", "match_pairs"))
    (one, other, p, m), _ = _pairs(subject)
    # Equal ones too, where a bound has the least to spare.
    for memory in (other, one):
        sketches = sketch(one), sketch(memory)
        found, matches = bound(*sketches, p, m % len(memory)), exact(one, memory, p, m % len(memory))
        asked = found.dtype == np.float32 and found.shape == matches.shape and bool((found >= matches).all())
        expect(asked, "match_at_most gives float32 for each pair of sketches, no less than match_pairs gives")
    expect(sketch(one[:0]).shape == (0, sketches[0].shape[1]), "of no signatures there are no sketches")


@matching_suite.add
def _matches_bytes_if_it_says_so(subject: EncoderSubject) -> None:
    if not getattr(subject.encoder, "matches_bytes", False):
        raise DoesNotApply("it does not say that it matches bytes, which is optional")
    compare = _offered(subject, "match_pairs")
    (one, other, p, m), _ = _pairs(subject)
    inside = all(rows.min(initial=0) >= 0 and rows.max(initial=1) <= 1 + ROUNDING for rows in (one, other))
    expect(inside, "signatures lie in 0..1 where matches_bytes says that bytes can stand for them")
    kept = [np.rint(255 * rows).astype(np.uint8) for rows in (one, other)]
    found, meant = compare(*kept, p, m), compare(*(rows / np.float32(255) for rows in kept), p, m)
    asked = found.dtype == np.float32 and np.allclose(found, meant, atol=ROUNDING)
    expect(asked, "match_pairs gives float32 of bytes, as of the same values in 255ths of 1")
    same = np.array_equal(compare(*kept, p[:1], m[:1]), found[:1])
    expect(same, "a pair of bytes has the same match, to the bit, whichever pairs stand beside it")
    if getattr(subject.encoder, "matches_by_sketch", False):
        bounds = subject.encoder.match_at_most(*map(subject.encoder.sketch, kept), p, m)  # type: ignore[attr-defined]
        expect(bool((bounds >= found).all()), "match_at_most of sketches of bytes is no less than match_pairs gives")


@matching_suite.add
def _matches_by_overlap_if_it_says_so(subject: EncoderSubject) -> None:
    if not getattr(subject.encoder, "matches_by_overlap", False):
        raise DoesNotApply("it does not say that it matches by overlap, which is optional")
    one, other = subject.signatures
    zero = np.zeros((1, one.shape[1]), np.float32)
    # Of signs that may differ, and of nothing.
    for queries, memory in ((one, other), (-one, other), (zero, other), (zero, zero)):
        asked = np.array_equal(subject.encoder.match(queries, memory), _overlap(queries, memory))
        expect(asked, "match is 2 sum of shares / (L1(a) + L1(b)), to the bit, where matches_by_overlap says so")


def _overlap(queries: NDArray[np.float32], memory: NDArray[np.float32]) -> NDArray[np.float32]:
    """The overlap of every query with every stored signature, summed in order."""
    a, b = queries[:, None], memory[None]
    shares = np.maximum(np.minimum(a, b), 0) - np.minimum(np.maximum(a, b), 0)
    asked, held, common = (_sum(np.abs(values)) for values in (queries, memory, shares))
    total = asked[:, None] + held[None]
    return np.divide(np.float32(2) * common, total, out=np.ones_like(total), where=total > 0)


def _sum(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """The sum over the last axis, from the first value to the last; `sum` itself adds up in pairs."""
    return np.cumsum(values, axis=-1, dtype=np.float32)[..., -1]
