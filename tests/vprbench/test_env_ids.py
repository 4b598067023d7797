"""Every registered environment passes Gymnasium's own check; KITTI's on a tree of its shape and numbers."""

from __future__ import annotations

from pathlib import Path

import cv2
import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from vprbench.catalogue import catalogue

KITTI = {name: entry for name, entry in catalogue().entries.items() if entry.reader == "kitti-odometry"}


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """KITTI's layout with every frame of every route: one small picture, driven round and round a circle of 20 m."""
    root = tmp_path_factory.mktemp("kitti")
    picture = np.random.default_rng(0).integers(0, 255, (36, 120), dtype=np.uint8)
    png = cv2.imencode(".png", picture)[1].tobytes()
    needed: dict[str, set[int]] = {}
    for entry in KITTI.values():
        for sequence, frames in entry.frames().items():
            needed.setdefault(sequence, set()).update(frames)
    for sequence, numbers in needed.items():
        folder = root / "dataset" / "sequences" / sequence
        (folder / "image_0").mkdir(parents=True)
        for number in numbers:
            (folder / "image_0" / f"{number:06d}.png").write_bytes(png)
        (folder / "calib.txt").write_text("P0: 70 0 60 0 0 70 18 0 0 0 1 0\n")
        angles = np.arange(max(numbers) + 1) / 20.0
        (folder / "times.txt").write_text("".join(f"{index / 10:e}\n" for index in range(len(angles))))
        (root / "dataset" / "poses").mkdir(exist_ok=True)
        poses = [
            f"{np.cos(a)} 0 {np.sin(a)} {-20 * np.cos(a)} 0 1 0 0 {-np.sin(a)} 0 {np.cos(a)} {20 * np.sin(a)}\n"
            for a in angles
        ]
        (root / "dataset" / "poses" / f"{sequence}.txt").write_text("".join(poses))
    return root


def test_every_route_has_an_environment() -> None:
    registered = {name for name in gym.registry if name.startswith("vprbench/")}
    assert registered == {f"vprbench/{name}-v0" for name in (*catalogue().names(), "Route")}


@pytest.mark.parametrize("name", KITTI)
def test_gymnasium_finds_no_fault(name: str, tree: Path) -> None:
    check_env(gym.make(f"vprbench/{name}-v0", data=tree, render_mode="rgb_array").unwrapped)
