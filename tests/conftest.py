"""Fixtures shared by every test."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def kitti_root() -> Path:
    """The folder with real KITTI frames, in KITTI's own layout."""
    candidates = [os.environ.get("VPRBENCH_DATA"), REPOSITORY.parent / "shared" / "kitti"]
    for root in (Path(c) for c in candidates if c):
        if (root / "dataset" / "poses" / "00.txt").is_file():
            return root
    pytest.skip("no real KITTI frames: set VPRBENCH_DATA to the folder that holds KITTI's dataset/")
