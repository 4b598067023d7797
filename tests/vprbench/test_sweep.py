"""Sweeps from the command line: whole, resumed, interrupted, failing; always the same table."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import pandas as pd
import pytest

from vprbench.cli import main
from vprbench.errors import ConfigError
from vprbench.sweep import Cell, Sweep, builtin_sweeps, jobs, load_sweep, matching

THIRD_PARTY = Path(__file__).parents[1] / "third_party"

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

class Rogue:
    recruiting = "step"
    def clear(self, sampling): pass
    def learn(self, observation): return None
    def respond(self, observation): return None

class Dies(Rogue):
    def fit(self, drives): os._exit(7)

class Hangs(Rogue):
    def fit(self, drives): time.sleep(600)

class Raises(Rogue):
    def fit(self, drives): raise ValueError("no such luck")
"""
ROGUE_ENTRIES = """
[vprbench.localizers]
dies = rogues:Dies
hangs = rogues:Hangs
raises = rogues:Raises
"""


@pytest.fixture
def here(tmp_path: Path) -> Path:
    """A folder with a question, its routes, and a distribution of rogues."""
    (tmp_path / "routes.toml").write_text(ROUTES)
    (tmp_path / "tiny.toml").write_text(QUESTION)
    (tmp_path / "site" / "rogues-0.1.dist-info").mkdir(parents=True)
    (tmp_path / "site" / "rogues.py").write_text(ROGUES)
    (tmp_path / "site" / "rogues-0.1.dist-info" / "METADATA").write_text("Name: rogues\nVersion: 0.1\n")
    (tmp_path / "site" / "rogues-0.1.dist-info" / "entry_points.txt").write_text(ROGUE_ENTRIES)
    return tmp_path


def environment(here: Path) -> dict[str, str]:
    return os.environ | {"PYTHONPATH": os.pathsep.join(map(str, (THIRD_PARTY, here / "site"))), "COLUMNS": "200"}


def vprbench(here: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "vprbench", *words]
    return subprocess.run(command, cwd=here, env=environment(here), capture_output=True, text=True, timeout=240)


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


def ask(here: Path, agents: dict[str, str], **others: str) -> None:
    """Write another question."""
    lines = ['routes = ["Tiny"]', "sampling_distances = [2]", 'routes_file = "routes.toml"']
    lines += [f"{key} = {value}" for key, value in others.items()]
    lines += ["[agents]", *(f"{name} = {{ {config} }}" for name, config in agents.items())]
    (here / "tiny.toml").write_text("\n".join(lines))


def test_a_sweep_answers_its_question_and_goes_on_where_it_stopped(here: Path) -> None:
    first = vprbench(here, "sweep", "tiny.toml", "--jobs", "1")
    assert first.returncode == 0, first.stderr
    table = pd.read_csv(here / "results" / "tiny.csv")
    assert len(table) == 8
    assert (table["status"] == "ok").all()
    assert (here / "results" / "tiny.toml").read_text() == QUESTION
    assert len(list((here / "results" / "tiny.traces").iterdir())) == 8
    assert pd.read_parquet(here / "results" / "tiny.parquet")["auc"].equals(table["auc"])

    answer = (here / "results" / "tiny.csv").read_bytes()
    again = vprbench(here, "sweep", "tiny.toml")
    assert "0 cells to measure" in again.stderr
    assert "8 already there" in again.stderr
    assert (here / "results" / "tiny.csv").read_bytes() == answer

    other = vprbench(here, "sweep", "tiny.toml", "--jobs", "2", "--out", "other")
    assert other.returncode == 0, other.stderr
    assert (here / "other" / "tiny.csv").read_bytes() == answer

    scored = vprbench(here, "score", "results/tiny.csv")
    assert "8 of 8 cells agree" in scored.stdout
    shown = vprbench(here, "table", "results/tiny.csv", "--metric", "accuracy", "--format", "markdown")
    assert "thumbnail" in shown.stdout

    (here / "results" / "tiny.csv").write_text(answer.decode().replace("0.5", "0.4"))
    forged = vprbench(here, "score", "results/tiny.csv")
    assert forged.returncode == 1
    assert "differs from its trace" in forged.stdout


def start(here: Path) -> subprocess.Popen[bytes]:
    """Start a sweep in a process group of its own, and wait for its first finished cell."""
    command = [sys.executable, "-m", "vprbench", "sweep", "tiny.toml", "--jobs", "1"]
    running = subprocess.Popen(
        command,
        cwd=here,
        env=environment(here),
        start_new_session=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    deadline = time.monotonic() + 120
    while not (here / "results" / "tiny.csv").exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    return running


def is_gone(group: int) -> bool:
    """Whether no process of the group is left; the last ones get a while to notice."""
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.2)
    return False


@pytest.mark.parametrize(("stop", "code"), [(signal.SIGINT, 130), (signal.SIGKILL, -signal.SIGKILL)])
def test_an_interruption_loses_no_finished_cell(here: Path, stop: signal.Signals, code: int) -> None:
    csv = here / "results" / "tiny.csv"
    running = start(here)
    running.send_signal(stop)
    # A sweep this small may come to its end before the signal does.
    assert running.wait(timeout=60) in (code, 0)
    assert is_gone(running.pid)
    kept = len(pd.read_csv(csv))
    assert 1 <= kept <= 8

    again = vprbench(here, "sweep", "tiny.toml", "--jobs", "1")
    assert f"{kept} already there" in again.stderr
    whole = vprbench(here, "sweep", "tiny.toml", "--jobs", "1", "--out", "whole")
    assert whole.returncode == 0
    assert csv.read_bytes() == (here / "whole" / "tiny.csv").read_bytes()


def test_rogues_fail_alone(here: Path) -> None:
    good = 'localizer = "thumbnail"'
    rogues = {name: f'localizer = "{name}"' for name in ("dies", "hangs", "raises")}
    broken = 'localizer = "nearest-view", encoder = "broken-patch"'
    ask(here, {**rogues, "broken": broken, "good": good})
    done = vprbench(here, "sweep", "tiny.toml", "--jobs", "2", "--timeout", "20")
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    table = pd.read_csv(here / "results" / "tiny.csv").set_index("agent")
    assert table["status"].to_dict() == {"good": "ok"} | dict.fromkeys([*rogues, "broken"], "failed")
    error = table["error"].astype(str)
    assert "worker process died" in error["dies"]
    assert "timed out" in error["hangs"]
    assert "no such luck" in error["raises"]
    assert "broken-patch" in error["broken"]
    assert "acme-vpr" in error["broken"]


def test_what_changed_is_measured_again(here: Path) -> None:
    ask(here, {"a": 'localizer = "thumbnail"', "b": 'localizer = "nearest-view", encoder = "mean-patch"'})
    assert vprbench(here, "sweep", "tiny.toml", "--jobs", "1").returncode == 0
    ask(here, {"a": 'localizer = "thumbnail"', "b": 'localizer = "nearest-view", encoder = "mean-patch", floor = 0.1'})
    again = vprbench(here, "sweep", "tiny.toml", "--dry-run")
    assert "1 cells to measure" in again.stderr
    assert "configuration or data changed" in again.stderr
    (here / "routes.toml").write_text(ROUTES.replace('"narrow"', '"wide"'))
    again = vprbench(here, "sweep", "tiny.toml", "--dry-run")
    assert "2 cells to measure" in again.stderr
    assert "seconds" in again.stdout


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (QUESTION.replace("routes =", "rotues ="), "did you mean 'routes'"),
        (QUESTION.replace("[2, 5]", "[2, -5]"), "sampling_distances.1"),
        (QUESTION.replace('"Tiny-2"', '"Tinny"'), "did you mean 'Tiny"),
        (QUESTION.replace('"mean-patch"', '"main-patch"'), "did you mean 'mean-patch'"),
        (QUESTION.replace('encoder = "mean-patch"', 'encoder = "mean-patch", flor = 1'), "did you mean 'floor'"),
        (QUESTION.replace("[2, 5]", "[2, 5"), "tiny.toml"),
    ],
)
def test_a_typo_is_told_in_one_line(here: Path, tell: Callable[..., Told], wrong: str, said: str) -> None:
    (here / "tiny.toml").write_text(wrong)
    done = tell("sweep", "tiny.toml")
    assert done.code == 2
    assert said in done.err
    assert len(done.err.splitlines()) == 1
    assert not (here / "results").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["sweep", "streats"], "did you mean 'streets'"),
        (["sweep", "streets", "--filter", "Wode"], "matches no cell"),
        (["run", "Street-Wied", "cohog"], "did you mean 'Street-Wide'"),
        (["run", "Street-Wide", "chog"], "did you mean 'cohog'"),
        (["list", "encodrs"], "did you mean 'encoders'"),
        (["check", "log-poler"], "did you mean 'log-polar'"),
        (["table", "nowhere.csv"], "nowhere.csv"),
        (["score", "nowhere.csv"], "nowhere.csv"),
    ],
)
def test_a_wrong_word_is_told_in_one_line(tell: Callable[..., Told], words: Sequence[str], said: str) -> None:
    done = tell(*words)
    assert done.code not in (0, 1)
    assert said in done.err
    assert len(done.err.splitlines()) == 1


def test_a_folder_that_cannot_be_written_is_told_before_anything_runs(here: Path, tell: Callable[..., Told]) -> None:
    (here / "results").write_text("a file in the way")
    done = tell("sweep", "tiny.toml")
    assert done.code == 3
    assert "--out" in done.err


def test_help_tells_every_command(tell: Callable[..., Told]) -> None:
    whole = tell("--help").out
    for command in ("sweep", "run", "table", "list", "score", "check"):
        assert command in whole
        assert "Example: vprbench " in " ".join(tell(command, "--help").out.split())


def test_the_lists_name_what_there_is(tell: Callable[..., Told]) -> None:
    everything = tell("list").out
    for name in ("Street-Wide", "KITTI-K5-1", "log-polar", "max-pi", "cohog", "streets", "k0-2", "acme-vpr"):
        assert name in everything


def test_every_built_in_sweep_is_sound() -> None:
    for name in builtin_sweeps():
        assert list(load_sweep(name)[1].cells())


def test_the_grid_is_the_product_with_seeds_only_where_they_matter() -> None:
    sweep = Sweep(routes=["A", "B"], sampling_distances=[2, 3], seeds=[0, 1], agents={"x": {"localizer": "cohog"}})
    cells = list(sweep.cells())
    assert [cell.id for cell in cells] == ["A/2m/x/s0", "A/3m/x/s0", "B/2m/x/s0", "B/3m/x/s0"]
    assert [len(job.cells) for job in jobs(sweep, cells)] == [2, 2]


def test_a_filter_matches_anywhere_in_the_id() -> None:
    cells = [Cell("K", "a", 2.0, 0), Cell("K", "b", 2.0, 0), Cell("K", "b", 5.0, 0)]
    assert matching(cells, "/b/") == cells[1:]
    assert matching(cells, "2m*b") == [cells[1]]
    with pytest.raises(ConfigError, match="matches no cell"):
        matching(cells, "9m")
