"""Comparing only the pairs of landmarks that matter, with whatever an encoder offers."""

from __future__ import annotations

from itertools import pairwise
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float32, Int64, UInt8

from vprbench.protocols import Encoder
from vprbench_localizers.unit_memory import Units

__all__ = ["ByteEncoder", "OverlapEncoder", "PairEncoder", "PairMatcher", "SketchingEncoder", "pair_matcher"]


@runtime_checkable
class PairEncoder(Encoder, Protocol):
    """An encoder that can also compare chosen pairs of signatures: optional, and only ever faster than `match`."""

    def match_pairs(
        self,
        queries: Float32[np.ndarray, "points size"],
        memory: Float32[np.ndarray, "units size"],
        query_index: Int64[np.ndarray, " pairs"],
        memory_index: Int64[np.ndarray, " pairs"],
    ) -> Float32[np.ndarray, " pairs"]:
        """`match(queries, memory)[query_index, memory_index]`; a pair's value depends on its two rows alone."""
        ...


@runtime_checkable
class SketchingEncoder(PairEncoder, Protocol):
    """One that can tell from less than the signatures how alike they are at most: optional.

    Attributes:
        matches_by_sketch: whether that is worth it.
    """

    matches_by_sketch: bool

    def sketch(self, signatures: Float32[np.ndarray, "rows size"]) -> Float32[np.ndarray, "rows sketch"]:
        """What is kept of each signature to bound its matches."""
        ...

    def match_at_most(
        self,
        queries: Float32[np.ndarray, "points sketch"],
        memory: Float32[np.ndarray, "units sketch"],
        query_index: Int64[np.ndarray, " pairs"],
        memory_index: Int64[np.ndarray, " pairs"],
    ) -> Float32[np.ndarray, " pairs"]:
        """Of pairs of sketches, matches that `match_pairs` does not exceed."""
        ...


@runtime_checkable
class OverlapEncoder(Encoder, Protocol):
    """An encoder that says how it matches, so that a memory of codes of few values can do it itself: optional.

    Attributes:
        matches_by_overlap: whether `match` is 2 sum of shares / (L1(a) + L1(b)), each sum in float32 from the first
            value to the last; two values share the smaller, if both have one sign; 1 of two rows of zeros.
    """

    matches_by_overlap: bool


@runtime_checkable
class ByteEncoder(PairEncoder, Protocol):
    """An encoder that can compare signatures of one byte a value: optional.

    Attributes:
        matches_bytes: whether its signatures lie in 0..1, and `match_pairs`, as `sketch` if it matches by sketch, also
            take them as uint8, in 255ths of 1.
    """

    matches_bytes: bool


class PairMatcher(Protocol):
    """How alike each pair (queries[query_index[i]], units.signatures[unit_index[i]]) is."""

    def __call__(
        self,
        queries: Float32[np.ndarray, "points size"] | UInt8[np.ndarray, "points size"],
        units: Units,
        query_index: Int64[np.ndarray, " pairs"],
        unit_index: Int64[np.ndarray, " pairs"],
    ) -> Float32[np.ndarray, " pairs"]:
        """The match of each pair."""
        ...


def pair_matcher(encoder: Encoder) -> PairMatcher:
    """The fastest comparison of chosen pairs that an encoder has.

    One that only has `match` compares one place at a time: matrix products round differently with the shape of their
    operands, and a place must respond the same whichever other places there are.
    """
    # By name, since Python takes longer to check a protocol than Max-Pi takes to compare a place.
    if pairs := getattr(encoder, "match_pairs", None):
        return lambda queries, units, p, m: pairs(queries, units.signatures, p, m)

    def of_all(
        queries: Float32[np.ndarray, "points size"],
        units: Units,
        query_index: Int64[np.ndarray, " pairs"],
        unit_index: Int64[np.ndarray, " pairs"],
    ) -> Float32[np.ndarray, " pairs"]:
        if not len(query_index):
            return np.empty(0, np.float32)
        spans = [slice(a, b) for a, b in pairwise(units.starts) if a < b]
        dense = np.concatenate([encoder.match(queries, units.signatures[span]) for span in spans], axis=1)
        return dense[query_index, unit_index]

    return of_all
