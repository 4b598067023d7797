"""A folder with a question, its routes and a distribution of rogues; and the command line to ask it with."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from vprbench.cli import main

THIRD_PARTY = Path(__file__).parents[2] / "third_party"

ROUTES = """
[routes.Tiny]
reader = "street"
environment = "narrow"
length = 20

[routes.Tiny-2]
reader = "street"
environment = "wide"
length = 20
"""

QUESTION = """
routes = ["Tiny", "Tiny-2"]
sampling_distances = [2, 5]
routes_file = "routes.toml"

[agents]
thumbnail = { localizer = "thumbnail" }
patches = { localizer = "nearest-view", encoder = "mean-patch" }
"""

# A distribution whose localizers misbehave in every way that a sweep must survive.
ROGUES = """
import os, time
from acme_vpr.thumbnail import Thumbnail

class Dies(Thumbnail):
    def fit(self, drives): os._exit(7)

class Hangs(Thumbnail):
    def fit(self, drives): time.sleep(600)

class Raises(Thumbnail):
    def fit(self, drives): raise ValueError("no such luck")

class Slow(Thumbnail):
    def fit(self, drives): time.sleep(3)
"""
ROGUE_ENTRIES = """
[vprbench.localizers]
dies = rogues:Dies
hangs = rogues:Hangs
raises = rogues:Raises
slow = rogues:Slow
"""


@pytest.fixture
def here(tmp_path: Path) -> Path:
    """The folder."""
    (tmp_path / "routes.toml").write_text(ROUTES)
    (tmp_path / "tiny.toml").write_text(QUESTION)
    (tmp_path / "site" / "rogues-0.1.dist-info").mkdir(parents=True)
    (tmp_path / "site" / "rogues.py").write_text(ROGUES)
    (tmp_path / "site" / "rogues-0.1.dist-info" / "METADATA").write_text("Name: rogues\nVersion: 0.1\n")
    (tmp_path / "site" / "rogues-0.1.dist-info" / "entry_points.txt").write_text(ROGUE_ENTRIES)
    return tmp_path


@pytest.fixture
def environment(here: Path) -> dict[str, str]:
    """The environment of a process that sees the third parties, and no commit, which may change meanwhile."""
    path = os.pathsep.join(map(str, (THIRD_PARTY, here / "site")))
    return os.environ | {"PYTHONPATH": path, "COLUMNS": "200", "GIT_DIR": str(here)}


@pytest.fixture
def vprbench(here: Path, environment: dict[str, str]) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run a command in a process of its own."""

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "vprbench", *words]
        return subprocess.run(command, cwd=here, env=environment, capture_output=True, text=True, timeout=240)

    return run


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def tell(here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """Run a command in this process, which is quicker where no worker is needed."""
    monkeypatch.chdir(here)
    monkeypatch.syspath_prepend(str(THIRD_PARTY))

    def run(*words: str) -> Told:
        monkeypatch.setattr(sys, "argv", ["vprbench", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run


@pytest.fixture
def ask(here: Path) -> Callable[[dict[str, str]], None]:
    """Write another question about the same route."""

    def write(agents: dict[str, str]) -> None:
        lines = ['routes = ["Tiny"]', "sampling_distances = [2]", 'routes_file = "routes.toml"', "[agents]"]
        (here / "tiny.toml").write_text(
            "\n".join([*lines, *(f"{name} = {{ {agent} }}" for name, agent in agents.items())])
        )

    return write
