"""`vprbench data check` on the small data sets of the readers' tests, whole and broken."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from vprbench.cli import main
from vprbench.data_checks import check_route

ROUTE = '[routes.{}]\nreader = "kitti-odometry"\nlearn = "00:0-9"\ntest = "00:15-24"\ntraining = ["00:10-14"]\n'
IMAGES = Path("dataset/sequences/00/image_0")


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


Tell = Callable[..., Told]


@pytest.fixture
def here(odometry_tree: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder and data root, with two routes in routes.toml that differ in name only."""
    (odometry_tree / "routes.toml").write_text(ROUTE.format("Road") + ROUTE.format("Same"))
    monkeypatch.chdir(odometry_tree)
    monkeypatch.setenv("VPRBENCH_DATA", str(odometry_tree))
    monkeypatch.setenv("COLUMNS", "200")
    return odometry_tree


@pytest.fixture
def tell(here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Tell:
    """Check data in this process."""

    def run(*words: str) -> Told:
        monkeypatch.setattr(sys, "argv", ["vprbench", "data", "check", *words, "--routes", "routes.toml"])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run


def test_warnings_are_shown_and_are_no_failure(tell: Tell) -> None:
    """The training drive is the end of the learn drive."""
    done = tell("Road")
    assert (done.code, done.err) == (0, "")
    assert "KITTI 00, frames 15-24      10     9.0      0.9            1.00" in done.out
    assert "test frame to nearest learn frame, mean       1.00 m" in done.out
    said = "warning  training: KITTI 00, frames 10-14, frames 10-14: 5 of 5 frames lie within 10 m of the route;"
    assert said in done.out
    assert done.out.splitlines()[-1] == "Road: 0 errors, 1 warnings"


def test_without_a_name_every_route_of_the_file_is_checked(tell: Tell) -> None:
    totals = [line for line in tell().out.splitlines() if "errors" in line]
    assert totals == ["Road: 0 errors, 1 warnings", "Same: 0 errors, 1 warnings"]


def test_all_that_is_broken_is_told_at_once(here: Path, tell: Tell) -> None:
    whole = (here / IMAGES / "000018.png").read_bytes()
    (here / IMAGES / "000003.png").write_bytes(b"")
    (here / IMAGES / "000018.png").write_bytes(whole[:-9])
    (here / IMAGES / "000020.png").write_bytes((here / IMAGES / "000001.png").read_bytes())
    done = tell("Road")
    assert done.code == 1
    assert "error    frames: KITTI 00, frames 0-9: " in done.out
    assert "000003.png: the file is empty; fetch the file again" in done.out
    assert "000018.png: the PNG is cut off; fetch the file again" in done.out
    said = (
        "error    shared-frames: KITTI 00, frames 0-9, frame 1: the very picture of KITTI 00, frames 15-24, frame 20;"
    )
    assert said in done.out
    assert done.out.splitlines()[-1] == "Road: 3 errors, 2 warnings"  # the picture is also that of another place


def test_what_does_not_load_is_a_finding(here: Path, tell: Tell) -> None:
    image = here / IMAGES / "000003.png"
    image.unlink()
    done = tell("Road")
    assert done.code == 1
    assert "error    files: Road: frames 0-24 of KITTI odometry sequence 00: 24 of 25 are in" in done.out
    image.touch()
    (here / "dataset/poses/00.txt").write_text("1 2 3\n")
    assert "error    loading: Road: " in tell("Road").out


def test_json_has_the_figures_and_the_findings(tell: Tell) -> None:
    first, second = map(json.loads, tell("Road", "Same", "--format", "json").out.splitlines())
    assert (first["route"], second["route"]) == ("Road", "Same")
    assert first["overlap"]["distance_max_m"] == pytest.approx(1.0)
    assert [(found["severity"], found["check"]) for found in first["findings"]] == [("warning", "training")]


def test_the_map_is_drawn(here: Path, tell: Tell) -> None:
    assert tell("Road", "--figures").err == "written: runs/figures/revisit-Road.png (and .svg)\n"
    assert (here / "runs/figures/revisit-Road.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (here / "runs/figures/revisit-Road.svg").read_bytes()


@pytest.mark.parametrize(
    ("words", "said"),
    [(["Raod"], "did you mean 'Road'?"), (["Road", "--format", "jsn"], "did you mean 'json'?")],
)
def test_a_wrong_word_is_told(tell: Tell, words: list[str], said: str) -> None:
    done = tell(*words)
    assert (done.code, len(done.err.splitlines())) == (2, 1)
    assert said in done.err


def test_another_sequence_lies_in_no_common_plane(here: Path) -> None:
    """Its images are copies too, but of frames that the route does not have."""
    (here / "dataset/sequences/01").symlink_to("00")
    (here / "dataset/poses/01.txt").symlink_to("00.txt")
    (here / "other.toml").write_text(ROUTE.format("Other").replace('"00:10-14"', '"01:10-14"'))
    assert check_route("Other", here, here / "other.toml").findings == ()


@pytest.mark.kitti
def test_the_real_revisit_has_its_figures(kitti_root: Path) -> None:
    """K0-2, whose training frames were chosen farther than 10 m away."""
    done = check_route("KITTI-K0-2", kitti_root)
    assert [(found.severity, found.check) for found in done.findings] == [
        ("warning", "distance"),
        ("warning", "heading"),
    ]
    assert done.overlap is not None
    assert done.overlap.figures()["distance_max_m"] < 5.0
