"""CoHOG against its description, written down once more in the plainest way: whole matrices in float64."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from skimage.filters import rank
from skimage.morphology import disk

from vprbench.catalogue import load_route
from vprbench.checks.samples import textured_frame
from vprbench.observation import observe
from vprbench.types import Frame, Observation
from vprbench_localizers.cohog import CoHOG
from vprbench_localizers.hog import Magnitude

Rows = NDArray[np.float64]


def reference_descriptors(frame: Frame, magnitude: Magnitude) -> Rows:
    """961 regions of 32 values."""
    grey = cv2.resize(frame, (512, 512))
    shaded = 255 * np.sqrt(grey / float(grey.max()))
    gx, gy = (cv2.Sobel(shaded, cv2.CV_64F, dx, 1 - dx, ksize=5) for dx in (1, 0))
    strength = np.hypot(gx, gy) if magnitude == "hypot" else np.abs(gx + gy) / 2
    angle = cv2.phase(gx, gy, angleInDegrees=True)
    cells = np.zeros((32, 32, 8))
    for i, j in product(range(32), repeat=2):
        area = np.s_[16 * i : 16 * i + 16, 16 * j : 16 * j + 16]
        first = np.floor_divide(angle[area], 45).astype(int)
        share = angle[area] % 45 / 45
        last = first == 8
        np.add.at(cells[i, j], np.where(last, 7, first), strength[area] * (1 - share))
        np.add.at(cells[i, j], np.where(last, 0, (first + 1) % 8), strength[area] * share)
    blocks = [
        np.concatenate([cells[i, j], cells[i, j + 1], cells[i + 1, j], cells[i + 1, j + 1]])
        for i, j in product(range(31), repeat=2)
    ]
    norms = [np.linalg.norm(block) for block in blocks]
    return np.array([block / norm if norm else block for block, norm in zip(blocks, norms, strict=True)])


def reference_kept(frame: Frame, threshold: float) -> NDArray[np.bool_]:
    """Which of the 961 regions are busy enough."""
    small = cv2.resize(cv2.resize(frame, (512, 512)), (100, 100))
    small_bits: Rows = rank.entropy(small, disk(5))  # type: ignore[no-untyped-call]
    bits = cv2.resize(small_bits, (512, 512))
    corners = product(range(0, 481, 16), repeat=2)
    return np.array([bits[y : y + 32, x : x + 32].sum() / (8 * 32 * 32) >= threshold for y, x in corners])


def reference_scores(
    queries: list[Frame], places: list[Frame], magnitude: Magnitude = "mean", threshold: float = 0.4
) -> Rows:
    """The score of each place for each query."""
    memory = [reference_descriptors(place, magnitude).T for place in places]
    scores = np.zeros((len(queries), len(places)))
    for query, row in zip(queries, scores, strict=True):
        kept = reference_kept(query, threshold)
        if kept.any():
            products = [(reference_descriptors(query, magnitude) @ place).max(axis=1) for place in memory]
            row[:] = [(best * kept).sum() / kept.sum() for best in products]
    return scores


def observation(frame: Frame) -> Observation:
    return Observation(frame=frame, heading=np.zeros(1), camera=np.array([370.0, 314.0]))


def scores(localizer: CoHOG, queries: list[Frame], places: list[Frame]) -> NDArray[np.float32]:
    described = [[localizer.describe(observation(frame)) for frame in frames] for frames in (queries, places)]
    return localizer.compare(*described)


def half_flat(seed: int) -> Frame:
    """A textured frame under a white sky: few regions are kept."""
    frame = textured_frame(seed)
    frame[:110] = 255
    return frame


@pytest.mark.parametrize(("magnitude", "threshold"), [("mean", 0.4), ("hypot", 0.4), ("mean", 0.5), ("mean", 0.0)])
def test_the_scores_of_textures_are_those_of_the_description(magnitude: Magnitude, threshold: float) -> None:
    queries, places = [textured_frame(1), half_flat(2)], [textured_frame(3), half_flat(1)]
    expected = reference_scores(queries, places, magnitude, threshold)
    found = scores(CoHOG(magnitude=magnitude, entropy_threshold=threshold), queries, places)
    assert 0.2 < expected.min() < expected.max() < 1
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)


def test_the_texture_under_a_sky_leaves_regions_out() -> None:
    assert 0 < reference_kept(half_flat(2), 0.4).mean() < 0.8


@pytest.mark.kitti
def test_the_scores_of_real_frames_are_those_of_the_description(kitti_root: Path) -> None:
    route = load_route("KITTI-K0-2", data=kitti_root)
    places = [observe(route.learn, index)["frame"] for index in (0, 7, 60)]
    queries = [observe(route.test, index)["frame"] for index in (0, 50)]
    np.testing.assert_allclose(scores(CoHOG(), queries, places), reference_scores(queries, places), rtol=0, atol=1e-6)
