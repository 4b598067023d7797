"""An index that finds the places of the landmarks most like a query's without comparing all: faiss's inverted lists.

Landmarks lie in lists, by the sector of their azimuth and the nearest of some typical looks. A query's looks only into
those of the looks nearest to its own, in the sectors about its direction. There a value of a vector is one byte.
"""

from __future__ import annotations

from importlib.util import find_spec
from math import isfinite, pi
from typing import Any

import numpy as np
from jaxtyping import Float32, Int64

from vprbench.errors import ConfigError
from vprbench_localizers.landmark_vectors import FOLDED, fold_of, landmark_vectors
from vprbench_localizers.unit_activity import View

__all__ = ["LandmarkIndex", "require_faiss"]

# Of 10 degrees each (our choice).
SECTORS = 36

# By which an azimuth counts (our choice): so that 10 degrees cost a pair of landmarks about a seventh of the most that
# looks are worth.
RADIUS = 3.0

# The vote of a pair that looks less alike than not at all, so that its place is still found if all are asked for.
LEAST = 1e-6

# Rounds of k-means that look for typical looks (our choice).
ROUNDS = 10


def require_faiss() -> None:
    """Raise ConfigError, with the remedy, unless faiss is installed."""
    if find_spec("faiss") is None:
        raise ConfigError("max-pi-ann: landmarks are indexed by faiss, not installed: pip install 'vprbench[ann]'")


class LandmarkIndex:
    """The vectors of places' landmarks.

    It works on the calling thread alone. faiss is loaded here, so late that the limits a worker sets at its start do
    not reach faiss's own threads.

    Args:
        samples: signatures among which typical looks are sought, at least one.
        looks: at most so many, and not more than samples.
        probes: so many looks are looked for with each landmark of a query.
        likeness: landmarks less alike do not count, 1: only equal ones.
        span: all sectors with azimuths at most so far from the query's are looked into, radians; inf: azimuths play
            no part.
    """

    def __init__(
        self, samples: Float32[np.ndarray, "samples size"], *, looks: int, probes: int, likeness: float, span: float
    ) -> None:
        import faiss

        faiss.omp_set_num_threads(1)
        self._fold = fold_of(samples.shape[1])
        self._likeness = likeness
        self._span, self._sectors = span, SECTORS if isfinite(span) else 1
        # Where all azimuths agree they must not part landmarks in the index either.
        self._weight = RADIUS if isfinite(span) else 0.0
        vectors = self._vectors(View(samples, np.zeros(len(samples), np.float32)))
        self._looks = _typical(vectors[:, :FOLDED].copy(), min(looks, len(samples)))
        self._probes = min(probes, len(self._looks))
        self._lists = _lists(self._sectors * len(self._looks), self._weight)
        self._places = 0

    def clear(self) -> None:
        """Forget every landmark; the typical looks stay."""
        self._lists.reset()
        self._places = 0

    def add(self, view: View, place: int) -> None:
        """Store the landmarks of a place, numbered from 0."""
        from faiss.contrib.ivf_tools import add_preassigned

        vectors = self._vectors(view)
        nearest = np.argmax(vectors[:, :FOLDED] @ self._looks.T, axis=1)
        lists = self._sector(view.azimuths) % self._sectors * len(self._looks) + nearest
        add_preassigned(self._lists, vectors, lists, np.full(len(vectors), place))
        self._places = max(self._places, place + 1)

    def places_like(self, view: View, most: int) -> Int64[np.ndarray, " places"]:
        """The places whose landmarks look most like a query's, at most so many, each once, rising."""
        from faiss.contrib.ivf_tools import range_search_preassigned

        if not self._places:
            return np.empty(0, np.int64)
        vectors, agreed = self._vectors(view), self._weight**2
        lists = self._lists_about(vectors, view.azimuths)
        self._lists.nprobe = lists.shape[1]
        _, products, places = range_search_preassigned(self._lists, vectors, agreed + self._likeness, lists)
        # Azimuths that agree give the same to all. Squared, a pair much alike counts for several that are less.
        votes = np.bincount(places, np.maximum(products - agreed, LEAST) ** 2, self._places)
        most = min(most, int(np.count_nonzero(votes)))
        return np.sort(np.argpartition(-votes, most - 1)[:most]) if most else np.empty(0, np.int64)

    def __sizeof__(self) -> int:
        """Bytes of the object and of the vectors and numbers that faiss keeps for it, out of Python's sight."""
        return super().__sizeof__() + self._lists.ntotal * (self._lists.code_size + np.dtype(np.int64).itemsize)

    def _vectors(self, view: View) -> Float32[np.ndarray, "points 64"]:
        return landmark_vectors(view, self._fold, self._weight)

    def _lists_about(
        self, vectors: Float32[np.ndarray, "points 64"], azimuths: Float32[np.ndarray, " points"]
    ) -> Int64[np.ndarray, "points lists"]:
        """The lists that each landmark of a query looks into, filled up with -1."""
        alike = vectors[:, :FOLDED] @ self._looks.T
        looks = np.argsort(-alike, axis=1, kind="stable")[:, None, : self._probes]
        sectors = self._sectors_about(azimuths)[..., None]
        return np.where(sectors >= 0, sectors * len(self._looks) + looks, -1).reshape(len(vectors), -1)

    def _sectors_about(self, azimuths: Float32[np.ndarray, " points"]) -> Int64[np.ndarray, "points sectors"]:
        """The sectors with azimuths within the span of each of these, filled up with -1."""
        if self._sectors == 1:
            return np.zeros((len(azimuths), 1), np.int64)
        first, last = self._sector(azimuths - self._span), self._sector(azimuths + self._span)
        sectors = first[:, None] + np.arange(min((last - first).max() + 1, self._sectors))
        return np.where(sectors <= last[:, None], sectors % self._sectors, -1)

    def _sector(self, azimuths: Float32[np.ndarray, " points"]) -> Int64[np.ndarray, " points"]:
        """The sector of each azimuth in -pi..pi, or how many it is beyond the first or last one."""
        return np.floor((azimuths + pi) * (self._sectors / (2 * pi))).astype(np.int64)


def _typical(vectors: Float32[np.ndarray, "samples 62"], count: int) -> Float32[np.ndarray, "looks 62"]:
    import faiss

    means = faiss.Kmeans(FOLDED, count, niter=ROUNDS, spherical=True, min_points_per_centroid=1, seed=0)
    means.train(vectors)
    looks: Any = means.centroids
    return looks


def _lists(count: int, radius: float) -> Any:  # noqa: ANN401 - faiss ships no types
    """So many empty lists of vectors, which are told in which to lie."""
    import faiss

    size = FOLDED + 2
    # It sorts nothing into lists, so it knows none.
    quantizer = faiss.IndexFlatIP(size)
    lists = faiss.IndexIVFScalarQuantizer(
        quantizer, size, count, faiss.ScalarQuantizer.QT_8bit, faiss.METRIC_INNER_PRODUCT, False
    )
    largest = np.full((1, size), radius, np.float32)
    largest[:, :FOLDED] = 1
    lists.sq.train(np.concatenate([-largest, largest]))
    lists.is_trained = True
    return lists
