"""Fixtures shared by every test."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import settings

from vprbench.route import Camera, Route, Traverse
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Frame

# A loaded machine is slow, not wrong.
settings.register_profile("vprbench", deadline=None)
settings.load_profile("vprbench")

REPOSITORY = Path(__file__).parents[1]


@pytest.fixture(scope="session", autouse=True)
def no_cache() -> Iterator[None]:
    """Keep no fitted encoders from test to test, nor among those of whoever runs the tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("VPRBENCH_CACHE", "none")
        yield


@pytest.fixture(scope="session")
def kitti_root() -> Path:
    """The folder with real KITTI frames, in KITTI's own layout."""
    candidates = [os.environ.get("VPRBENCH_DATA"), REPOSITORY.parent / "shared" / "kitti"]
    for root in (Path(c) for c in candidates if c):
        if (root / "dataset" / "poses" / "00.txt").is_file():
            return root
    pytest.skip("no real KITTI frames: set VPRBENCH_DATA to the folder that holds KITTI's dataset/")


class Texture:
    """Frames of a long random texture that slides by, so that near frames look alike and far ones do not."""

    def __init__(self, offsets: np.ndarray, seed: int) -> None:
        rng = np.random.default_rng(seed)
        coarse = rng.integers(0, 255, (24, 400), dtype=np.uint8)
        self.picture = cv2.resize(coarse, (400 * 16, FRAME_HEIGHT), interpolation=cv2.INTER_CUBIC)
        self.offsets = (np.asarray(offsets) * 8).astype(int)

    def __getitem__(self, index: int) -> Frame:
        start = self.offsets[index]
        return self.picture[:, start : start + FRAME_WIDTH].copy()


def toy_traverse(name: str, metres: np.ndarray, aside: float, seed: int) -> Traverse:
    """A drive due north past the texture, `aside` metres to the east."""
    frames = len(metres)
    return Traverse(
        name=name,
        frames=Texture(metres, seed),
        positions=np.column_stack([np.full(frames, aside), metres]),
        headings=np.zeros(frames),
        times=np.arange(frames) / 10.0,
        camera=Camera(fx=372.0, cx=314.0),
        indices=np.arange(frames) + 100,
        checksum=f"{name}-{seed}",
    )


@pytest.fixture(scope="session")
def toy_route() -> Route:
    """A route of 40 m whose frames are quick to make; the drives have 41 and 30 frames."""
    learn = toy_traverse("toy learn", np.linspace(0.0, 40.0, 41), 0.0, seed=0)
    test = toy_traverse("toy test", np.linspace(0.3, 39.7, 30), 0.4, seed=0)
    elsewhere = toy_traverse("toy training", np.linspace(0.0, 90.0, 10), 0.0, seed=1)
    return Route("toy", learn, test, (elsewhere,), environment="toy")
