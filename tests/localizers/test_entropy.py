from __future__ import annotations

from math import log2

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from skimage.filters import rank
from skimage.morphology import disk

from vprbench.checks.samples import textured_frame
from vprbench_localizers.entropy import _slide, local_entropy, region_entropy


def plain_entropy(image: NDArray[np.uint8], radius: int = 5) -> NDArray[np.float64]:
    return np.asarray(rank.entropy(image, disk(radius)))  # type: ignore[no-untyped-call]


@settings(deadline=None, max_examples=40)
@given(
    height=st.integers(1, 25),
    width=st.integers(1, 25),
    radius=st.integers(1, 7),
    greys=st.integers(1, 256),
    seed=st.integers(0, 2**32 - 1),
)
def test_the_entropy_is_that_of_scikit_image(height: int, width: int, radius: int, greys: int, seed: int) -> None:
    image = np.random.default_rng(seed).integers(0, greys, (height, width), dtype=np.uint8)
    np.testing.assert_allclose(local_entropy(image, radius), plain_entropy(image, radius), rtol=0, atol=1e-12)


def test_all_different_greys_hold_the_logarithm_of_their_number() -> None:
    image = np.arange(121, dtype=np.uint8).reshape(11, 11)
    bits = local_entropy(image)
    assert bits[5, 5] == pytest.approx(log2(81), abs=1e-12)
    # A quarter of the disk and half of each axis lie inside at a corner: 6 + 6 + 5 + 5 + 4 + 1 - 1 pixels.
    assert bits[0, 0] == pytest.approx(log2(26), abs=1e-12)


def test_two_greys_in_equal_shares_hold_one_bit() -> None:
    image = np.zeros((1, 10), np.uint8)
    image[0, 5:] = 9
    assert local_entropy(image)[0, 4] == pytest.approx(1.0, abs=1e-12)
    assert local_entropy(image)[0, 9] == pytest.approx(-(log2(1 / 6) + 5 * log2(5 / 6)) / 6, abs=1e-12)


def test_sliding_leaves_no_rounding_behind() -> None:
    image = np.zeros((12, 600), np.uint8)
    image[:, :580] = np.random.default_rng(0).integers(0, 5, (12, 580))
    assert (local_entropy(image)[:, 586:] == 0).all()


def test_a_region_has_the_mean_of_the_enlarged_map() -> None:
    image = cv2.resize(textured_frame(5), (512, 512))
    bits = cv2.resize(plain_entropy(np.asarray(cv2.resize(image, (100, 100)), np.uint8)), (512, 512))
    means = [[bits[y : y + 32, x : x + 32].mean() / 8 for x in range(0, 481, 16)] for y in range(0, 481, 16)]
    np.testing.assert_allclose(region_entropy(image), means, rtol=1e-6)


@pytest.mark.parametrize("grey", [0, 128, 255])
def test_a_uniform_image_has_no_entropy(grey: int) -> None:
    assert (region_entropy(np.full((512, 512), grey, np.uint8)) == 0).all()


def test_a_disk_of_one_grey_reads_no_further_than_its_own_area() -> None:
    """The 5 pixels of a disk of radius 1; whatever lies behind the table in memory is no number."""
    counts = np.arange(1.0, 6.0)
    behind = np.concatenate([[0.0], counts * np.log2(counts), np.full(8, np.nan)])
    assert (_slide(np.zeros((5, 9), np.uint8), np.array([0, 1, 0]), behind[:6]) == 0).all()
