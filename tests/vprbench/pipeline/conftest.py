"""Roads whose every position is known to the test, driven twice, and the doors through which agents are measured."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path

import cv2
import numpy as np
import pytest

from vprbench.runner import Outcome, run
from vprbench.sweep import Cell, Job
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH

SITE = Path(__file__).parent / "site"

# Column from which the second drive of Mirror sees negatives: as many as make recognition hard, not hopeless.
SEAM = 270


@dataclass(frozen=True)
class World:
    """A folder with a file of routes, and where both drives of each one really are, metres."""

    folder: Path
    drives: dict[str, tuple[np.ndarray, np.ndarray]]

    @property
    def routes(self) -> Path:
        return self.folder / "routes.toml"


@pytest.fixture(scope="session")
def world(tmp_path_factory: pytest.TempPathFactory) -> World:
    """Three pairs of drives, two of them told again, shuffled or swapped; and a drawn street."""
    folder, rng = tmp_path_factory.mktemp("world"), np.random.default_rng(0)
    learn = np.column_stack([np.zeros(81), np.arange(81.0)])
    north = np.linspace(0.1, 79.9, 150) + rng.uniform(-0.05, 0.05, 150)
    beside = np.column_stack([0.8 + 0.7 * np.sin(north / 9), north])
    west, east = (np.column_stack([np.full(60, aside), np.arange(60.0)]) for aside in (0.0, 1.0))
    first, second = photographs(rng, 81), photographs(rng, 150)
    scenes = list(passing(rng, 60))
    tell, drives = teller(folder), {}
    order = rng.permutation(150)
    drives["Beside"] = tell("Beside", (learn, first), (beside, second))
    drives["Shuffled"] = tell("Shuffled", (learn, first), (beside[order], [second[index] for index in order]))
    drives["Swapped"] = tell("Swapped", (beside, second), (learn, first))
    drives["Same"] = tell("Same", (west, scenes), (west, scenes))
    negatives = [negative(scene) for scene in scenes]
    drives["Mirror"] = tell("Mirror", (west, scenes), (east, negatives))
    drives["Mirrored"] = tell("Mirrored", (east, negatives), (west, scenes))
    with (folder / "routes.toml").open("a") as file:
        file.write('[routes.Drawn]\nreader = "street"\nenvironment = "narrow"\nlength = 24\n')
    return World(folder, drives)


Told = tuple[np.ndarray, Sequence[np.ndarray]]


def teller(folder: Path) -> Callable[[str, Told, Told], tuple[np.ndarray, np.ndarray]]:
    """Write routes of positions and frames, one after the other."""

    def tell(name: str, learn: Told, test: Told) -> tuple[np.ndarray, np.ndarray]:
        for phase, (positions, frames) in {"learn": learn, "test": test}.items():
            write_drive(folder / f"{name}-{phase}", positions, frames)
        with (folder / "routes.toml").open("a") as file:
            file.write(f'[routes.{name}]\nreader = "folder"\nlearn = "{name}-learn"\ntest = "{name}-test"\n')
            file.write("camera = { field_of_view_deg = 82.0 }\n")
        return learn[0], test[0]

    return tell


def write_drive(folder: Path, positions: np.ndarray, frames: Sequence[np.ndarray]) -> None:
    """A drive of one's own, as docs/routes.md has it."""
    folder.mkdir()
    with (folder / "frames.csv").open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["file", "time", "east", "north", "heading_deg"])
        for index, (position, frame) in enumerate(zip(positions, frames, strict=True)):
            cv2.imwrite(str(folder / f"{index}.png"), frame)
            rows.writerow([f"{index}.png", 10 * index, *map(repr, position.tolist()), 0])


def photographs(rng: np.random.Generator, frames: int) -> list[np.ndarray]:
    """Frames that have nothing in common."""
    return list(rng.integers(0, 256, (frames, 5, 17), np.uint8))


def passing(rng: np.random.Generator, frames: int) -> Iterator[np.ndarray]:
    """Frames of a texture that slides by, 24 columns a frame."""
    blocks = rng.integers(0, 256, (FRAME_HEIGHT // 4, (FRAME_WIDTH + 24 * frames) // 12 + 1), np.uint8)
    texture = np.kron(blocks, np.ones((4, 12), np.uint8))
    for start in range(0, 24 * frames, 24):
        yield texture[:, start : start + FRAME_WIDTH]


def negative(frame: np.ndarray) -> np.ndarray:
    """The frame, its right part as a negative."""
    return np.concatenate([frame[:, :SEAM], 255 - frame[:, SEAM:]], axis=1)


@pytest.fixture(scope="session")
def drives(world: World) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Positions of the learn and test frames of each route, metres."""
    return world.drives


@pytest.fixture(scope="session")
def routes(world: World) -> Path:
    """The file of the routes."""
    return world.routes


@pytest.fixture(scope="module")
def side_door() -> Iterator[None]:
    """While it is open, the side door's localizers are installed."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(SITE))
        yield


Answer = Callable[..., Outcome]


@pytest.fixture(scope="module")
def answer(world: World, side_door: None) -> Answer:
    """Measure one cell as a sweep would; the localizers of the side door are told the route."""
    unique = count()

    def measure(route: str, name: str, distance: float = 4.0, seed: int = 0, **options: object) -> Outcome:
        told = {} if name == "pixels" else {"route": route, "routes": str(world.routes)}
        cell = Cell(route, f"{name}-{next(unique)}", distance, seed)
        job = Job(route, cell.agent, seed, {"localizer": name, **told, **options}, (cell,))
        (outcome,) = run(job, None, world.routes)
        return outcome

    return measure
