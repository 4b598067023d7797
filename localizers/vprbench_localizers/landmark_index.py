"""An index that finds the stored landmarks most like a query's without comparing all: faiss's inverted lists.

A landmark is a vector: its signature, each value by its root and the whole at unit length, and its azimuth as a point
on a circle. The product of two vectors then falls as signatures or azimuths part. Landmarks lie in lists by the nearest
of some typical ones, and a query looks only into the lists nearest to it. There a value is one byte.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

import numpy as np
from jaxtyping import Float32, Int64

from vprbench.errors import ConfigError
from vprbench_localizers.unit_activity import View

__all__ = ["LandmarkIndex", "landmark_vectors", "require_faiss"]

# Values of a vector are filled up with zeros to a multiple of this: faiss compares others one value at a time.
LANES = 16

# Rounds of k-means that look for typical landmarks (our choice: more did not help).
ROUNDS = 10


def require_faiss() -> None:
    """Raise ConfigError, with the remedy, unless faiss is installed."""
    if find_spec("faiss") is None:
        raise ConfigError("max-pi-ann: landmarks are indexed by faiss, not installed: pip install 'vprbench[ann]'")


def landmark_vectors(view: View, azimuth_weight: float) -> Float32[np.ndarray, "points lanes"]:
    """The vector of each landmark; the azimuth counts as much as the signature where its weight is 1."""
    points, size = view.signatures.shape
    vectors = np.zeros((points, -(-(size + 2) // LANES) * LANES), np.float32)
    vectors[:, :size] = np.sign(view.signatures) * np.sqrt(np.abs(view.signatures))
    vectors /= np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), np.finfo(np.float32).tiny)
    vectors[:, size] = azimuth_weight * np.cos(view.azimuths)
    vectors[:, size + 1] = azimuth_weight * np.sin(view.azimuths)
    return vectors


class LandmarkIndex:
    """Vectors of landmarks, numbered in the order in which they were added.

    It works on the calling thread alone. faiss is loaded here, so late that the limits a worker sets at its start do
    not reach faiss's own threads.

    Args:
        samples: vectors among which typical ones are sought, at least one.
        lists: at most so many, and not more than samples.
        probes: so many lists are looked into for each landmark of a query.
    """

    def __init__(self, samples: Float32[np.ndarray, "samples size"], lists: int, probes: int) -> None:
        import faiss

        faiss.omp_set_num_threads(1)
        lists = min(lists, len(samples))
        index: Any = faiss.index_factory(samples.shape[1], f"IVF{lists},SQ8", faiss.METRIC_INNER_PRODUCT)
        index.nprobe = probes
        # What faiss warns of otherwise: few samples make poor lists, which cost time and recall but are no fault.
        index.cp.min_points_per_centroid = 1
        index.cp.niter = ROUNDS
        index.train(samples)
        self._index = index

    def clear(self) -> None:
        """Forget every landmark; the lists stay."""
        self._index.reset()

    def add(self, vectors: Float32[np.ndarray, "points size"]) -> None:
        """Store these landmarks."""
        self._index.add(vectors)

    def nearest(self, vectors: Float32[np.ndarray, "points size"], count: int) -> Int64[np.ndarray, " found"]:
        """The numbers of the `count` stored landmarks most like each of these, each number once, rising."""
        _, found = self._index.search(vectors, count)
        numbers = np.unique(found)
        return numbers[numbers >= 0]
