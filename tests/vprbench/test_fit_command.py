"""`vprbench fit`: what it leaves behind, what it says, and what it never passes off as today's."""

from __future__ import annotations

import csv
import json
import math
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np
import pytest

from vprbench.agents import build_encoder
from vprbench.catalogue import load_route
from vprbench.checks.samples import textured_frame
from vprbench.cli import main
from vprbench.types import Frame, LearningStep

THIRD_PARTY = Path(__file__).parents[1] / "third_party"

ROUTES = """
[routes.Tiny]
reader = "folder"
learn = "0"
test = "1"
training = ["2"]
camera.field_of_view_deg = 80

[routes.Street]
reader = "street"
environment = "narrow"
length = 20
"""

# Frames of each drive of the route Tiny.
FRAMES = 8


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with routes and a cache."""
    (tmp_path / "routes.toml").write_text(ROUTES)
    for drive in range(3):
        (tmp_path / str(drive)).mkdir()
        lines = ["file,time,east,north,heading_deg", *(f"{t}.png,{t},{drive},{t},0" for t in range(FRAMES))]
        (tmp_path / str(drive) / "frames.csv").write_text("\n".join(lines))
        for t in range(FRAMES):
            assert cv2.imwrite(str(tmp_path / str(drive) / f"{t}.png"), textured_frame(100 * (drive // 2) + t))
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(THIRD_PARTY))
    monkeypatch.setenv("VPRBENCH_CACHE", "cache")
    monkeypatch.setenv("ACME_FITS", "learned")
    monkeypatch.setenv("COLUMNS", "200")
    return tmp_path


@pytest.fixture
def fit(here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """Run `vprbench fit` on the route, in this process."""

    def run(*words: str) -> Told:
        command = ["vprbench", "fit", *words, "--routes", "routes.toml", "--out", "out"]
        monkeypatch.setattr(sys, "argv", [*command, *(() if "--route" in words else ("--route", "Tiny"))])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run


Run = Callable[..., Told]


def rows() -> list[dict[str, str]]:
    with Path("out/fit.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def timings() -> list[dict[str, Any]]:
    fits: list[dict[str, Any]] = json.loads(Path("out/fit-timings.json").read_text())["fits"]
    return fits


def learned() -> int:
    return len(Path("learned").read_text().split())


def test_every_encoder_and_seed_is_a_row_a_file_and_a_timing(fit: Run) -> None:
    done = fit("typical", "name = 'typical', size = 2", "mean-patch", "--seeds", "1,0,1")
    assert done.code == 0, done.err
    names = [("mean-patch", "1"), *((name, seed) for name in ("typical", "typical[size=2]") for seed in "01")]
    assert [(row["encoder"], row["seed"]) for row in rows()] == names
    assert [(one["encoder"], one["seed"]) for one in timings()] == names
    files = {path.name for path in Path("out").glob("*.npz")}
    assert files == {f"{encoder}-s{seed}.npz" for encoder, seed in names[1:]}
    row = rows()[3]
    made: Any = type(build_encoder("typical")).load(Path("out/typical[size=2]-s0.npz"))  # type: ignore[attr-defined]
    assert float(row["weight"]) == pytest.approx(made.weights.mean(), rel=1e-5)
    assert json.loads(row["encoder_config"]) == {"name": "typical", "size": 2}
    assert (row["route"], row["plugin"], row["training_frames"]) == ("Tiny", "acme-vpr 1.2", str(FRAMES))
    assert {"vprbench", "commit", "libraries", "training_checksum"} <= row.keys()
    assert not [name for name in row if "seconds" in name]
    seconds = timings()[3]["seconds"]
    assert 0 < seconds["weight_seconds"] == made.seconds <= seconds["fit_seconds"]
    assert {"processor", "cores", "python", "libraries"} <= timings()[3]["machine"].keys()
    assert rows()[0]["weight"] == ""


def test_the_means_over_seeds_are_shown(fit: Run) -> None:
    done = fit("typical", "mean-patch", "--seeds", "0,1")
    weights = [float(row["weight"]) for row in rows() if row["encoder"] == "typical"]
    line = next(line for line in done.out.splitlines() if line.split()[:1] == ["weight"])
    mean, sign, sd, other = line.split()[1:]
    assert (sign, other) == ("±", "-")
    assert float(mean) == pytest.approx(np.mean(weights), rel=1e-3)
    assert float(sd) == pytest.approx(np.std(weights, ddof=1), rel=1e-2)
    assert [line for line in done.out.splitlines() if line.strip().startswith("fit_seconds")]


def test_the_table_has_the_same_bytes_again_and_no_time_that_was_not_taken(fit: Run) -> None:
    fit("typical", "--seeds", "0,1")
    answer, first = Path("out/fit.csv").read_bytes(), timings()
    done = fit("typical", "--seeds", "0,1")
    assert done.err.count("learned before, so not timed now (--refit learns it again)") == 2
    assert "seconds" not in done.out
    assert (Path("out/fit.csv").read_bytes(), timings(), learned()) == (answer, first, 2)
    fit("typical", "--seeds", "0,1", "--refit")
    assert (Path("out/fit.csv").read_bytes(), learned()) == (answer, 4)
    assert timings() != first


def test_other_fits_of_the_folder_stay(fit: Run) -> None:
    fit("typical")
    fit("mean-patch")
    fit("typical", "--seeds", "1")
    fitted = [(row["encoder"], row["seed"]) for row in rows()]
    assert fitted == [("mean-patch", "0"), ("typical", "0"), ("typical", "1")]
    assert len(timings()) == 3


def test_what_learns_with_progress_shows_it(
    fit: Run, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setattr("vprbench.cli.fitting.Progress.update", spy := Spy())
    assert fit("typical").code == 0
    assert spy.said[0] == (0, 1, "typical-s0: fit")
    done, total, text = spy.said[-1]
    assert (done, total) == (FRAMES, FRAMES)
    assert text.startswith("typical-s0: brightness 8/8, mean 0.")


class Spy:
    """Stands in for a bar's update, and notes what is shown."""

    def __init__(self) -> None:
        self.said: list[tuple[int, int, str]] = []

    def __call__(self, bar: object, *, completed: int, total: int, description: str) -> None:
        self.said.append((completed, total, description))


def test_a_sweep_that_follows_starts_at_once(here: Path, fit: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    fit("typical")
    agent = 'localizer = "nearest-view", encoder = "typical"'
    monkeypatch.setattr(sys, "argv", ["vprbench", "run", "Tiny", agent, "--routes", "routes.toml"])
    main_ended()
    assert learned() == 1


def main_ended() -> None:
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code


def test_figures_are_drawn_of_the_first_seed_and_of_all(fit: Run) -> None:
    pytest.importorskip("matplotlib")
    assert fit("typical", "mean-patch", "--seeds", "0,1", "--figures").code == 0
    drawn = {path.name for path in Path("out/figures").iterdir()}
    stems = ("typical-s0-weights", "measure-weight", "measure-seconds")
    assert drawn == {f"{stem}.{kind}" for stem in stems for kind in ("png", "svg")}


def test_an_encoder_that_fails_takes_no_other_down(fit: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def learning(self: Any, frames: object) -> Iterator[LearningStep]:  # noqa: ANN401
        if self.seed == 0:
            raise ValueError("no such\nluck")
        yield LearningStep("S1", 1, 1)

    monkeypatch.setattr(type(build_encoder("typical")), "learning", learning)
    done = fit("typical", "--seeds", "0,1")
    assert done.code == 1
    assert "   1/2  typical-s0  failed: ValueError: no such luck\n" in done.err
    assert [row["seed"] for row in rows()] == ["1"]


def test_what_was_finished_before_an_interruption_is_kept(fit: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    good = type(build_encoder("typical")).learning  # type: ignore[attr-defined]

    def learning(self: Any, frames: list[Frame]) -> Iterator[LearningStep]:  # noqa: ANN401
        if self.seed == 1:
            raise KeyboardInterrupt
        yield from good(self, frames)

    monkeypatch.setattr(type(build_encoder("typical")), "learning", learning)
    done = fit("typical", "--seeds", "0,1,2")
    assert done.code == 130
    assert "interrupted: what was finished is kept" in done.err
    assert [row["seed"] for row in rows()] == ["0"]
    assert len(list(Path("out").glob("*.npz"))) == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["typicle"], "encoder typicle: no encoder is called 'typicle': did you mean 'typical'?"),
        (["name = 'typical', sise = 3"], "sise is not an option of encoder 'typical'"),
        (["name = "], "encoder 'name = ': not the inside of a TOML table"),
        (["size = 3"], "names no encoder: give its name"),
        (["typical", "--seeds", "0,one"], "--seeds '0,one': give whole numbers with commas between"),
        (["typical", "--seeds", "-1"], "--seeds '-1': give whole numbers"),
        (["typical", "--route", "Tyni"], "no route 'Tyni': did you mean 'Tiny'?"),
    ],
)
def test_a_fault_of_the_question_is_one_line(fit: Run, words: list[str], said: str) -> None:
    done = fit(*words)
    assert done.code != 0
    assert done.err.startswith("vprbench: ")
    assert said in done.err
    assert len(done.err.splitlines()) == 1
    assert not Path("learned").exists()


def test_figures_without_their_extra_are_told_before_anything_runs(fit: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vprbench.cli.fitting.find_spec", lambda name: None)
    done = fit("typical", "--figures")
    assert done.err == "vprbench: --figures needs matplotlib: pip install 'vprbench[figures]'\n"
    assert not Path("learned").exists()


@pytest.mark.parametrize(("name", "content"), [("fit.csv", "a,b\n1,2\n"), ("fit-timings.json", "{}")])
def test_a_folder_with_another_table_is_left_alone(fit: Run, name: str, content: str) -> None:
    Path("out").mkdir()
    (Path("out") / name).write_text(content)
    done = fit("typical")
    assert done.code == 3
    assert f"out/{name}: not readable as a table of fits" in done.err
    assert (Path("out") / name).read_text() == content


def test_a_folder_that_cannot_be_made_is_told(fit: Run) -> None:
    Path("out").touch()
    assert "--out out: cannot be written" in fit("typical").err


def test_a_small_hsd_is_fitted_measured_and_drawn(fit: Run) -> None:
    pytest.importorskip("matplotlib")
    small = "name = 'hsd', size = 4, steps = 10, picks = [3, 3], training_frames = 10"
    done = fit(small, "--route", "Street", "--figures")
    assert done.code == 0, done.err
    (row,) = rows()
    assert 0 < float(row["s1_rate"]) < 1
    assert not [value for value in row.values() if value == "nan"]
    assert math.isfinite(timings()[0]["seconds"]["s1_seconds"])
    assert len(list(Path("out/figures").glob("hsd*.svg"))) >= 2


@pytest.mark.kitti
def test_real_frames_are_learned_and_taken_from_the_store(fit: Run, kitti_root: Path) -> None:
    encoder = "name = 'hsd', size = 6, steps = 20, training_frames = 30"
    done = fit(encoder, "--route", "KITTI-K0-2", "--data", str(kitti_root))
    assert done.code == 0, done.err
    (row,) = rows()
    assert int(row["training_frames"]) == sum(map(len, load_route("KITTI-K0-2", kitti_root).training))
    assert 0.1 < float(row["s1_rate"]) < 1
    again = fit(encoder, "--route", "KITTI-K0-2", "--data", str(kitti_root))
    assert "learned before" in again.err
    assert rows() == [row]
