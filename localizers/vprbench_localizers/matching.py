"""Comparing only the pairs of landmarks that matter, with whatever an encoder offers."""

from __future__ import annotations

from itertools import pairwise
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float32, Int64

from vprbench.protocols import Encoder
from vprbench_localizers.unit_memory import UnitMemory

__all__ = ["PairEncoder", "match_pairs"]


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


def match_pairs(
    encoder: Encoder,
    queries: Float32[np.ndarray, "points size"],
    memory: UnitMemory,
    query_index: Int64[np.ndarray, " pairs"],
    memory_index: Int64[np.ndarray, " pairs"],
) -> Float32[np.ndarray, " pairs"]:
    """How alike each pair (queries[query_index[i]], memory unit memory_index[i]) is.

    An encoder that only has `match` compares one place at a time: matrix products round differently with the
    shape of their operands, and a place must respond the same whichever other places there are.
    """
    if isinstance(encoder, PairEncoder):
        return encoder.match_pairs(queries, memory.signatures, query_index, memory_index)
    if not len(query_index):
        return np.empty(0, np.float32)
    spans = [slice(a, b) for a, b in pairwise(memory.starts) if a < b]
    dense = np.concatenate([encoder.match(queries, memory.signatures[span]) for span in spans], axis=1)
    return dense[query_index, memory_index]
