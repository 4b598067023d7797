"""Comparing only the pairs of landmarks that matter, with whatever an encoder offers."""

from __future__ import annotations

from itertools import pairwise
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float32, Int64

from vprbench.protocols import Encoder
from vprbench_localizers.unit_memory import Units

__all__ = ["OverlapEncoder", "PairEncoder", "PairMatcher", "ThresholdEncoder", "matches_by_overlap", "pair_matcher"]


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
class ThresholdEncoder(PairEncoder, Protocol):
    """One that is faster still where only matches above some value count: optional."""

    def match_pairs_above(
        self,
        queries: Float32[np.ndarray, "points size"],
        memory: Float32[np.ndarray, "units size"],
        query_index: Int64[np.ndarray, " pairs"],
        memory_index: Int64[np.ndarray, " pairs"],
        floor: float,
    ) -> Float32[np.ndarray, " pairs"]:
        """What `match_pairs` gives, wherever that is above `floor`; elsewhere any value that is not above it."""
        ...


@runtime_checkable
class OverlapEncoder(Encoder, Protocol):
    """An encoder that says how it matches, so that a memory of codes of few values can do it itself: optional.

    Attributes:
        matches_by_overlap: whether `match` is 2 sum of shares / (L1(a) + L1(b)), each sum in float32 from the first
            value to the last; two values share the smaller, if both have one sign; 1 of two rows of zeros.
    """

    matches_by_overlap: bool


def matches_by_overlap(encoder: Encoder) -> bool:
    """Whether an encoder says that it matches by the overlap of codes."""
    return bool(getattr(encoder, "matches_by_overlap", False))


class PairMatcher(Protocol):
    """How alike each pair (queries[query_index[i]], units.signatures[unit_index[i]]) is, where above a floor."""

    def __call__(
        self,
        queries: Float32[np.ndarray, "points size"],
        units: Units,
        query_index: Int64[np.ndarray, " pairs"],
        unit_index: Int64[np.ndarray, " pairs"],
    ) -> Float32[np.ndarray, " pairs"]:
        """The match of each pair; where it is not above the floor, any value that is not either."""
        ...


def pair_matcher(encoder: Encoder, floor: float) -> PairMatcher:
    """The fastest comparison of chosen pairs that an encoder has.

    One that only has `match` compares one place at a time: matrix products round differently with the shape of their
    operands, and a place must respond the same whichever other places there are.
    """
    # By name, since Python takes longer to check a protocol than Max-Pi takes to compare a place.
    if above := getattr(encoder, "match_pairs_above", None):
        return lambda queries, units, p, m: above(queries, units.signatures, p, m, floor)
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
