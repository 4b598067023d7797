"""The examples on the page about routes are read as they stand."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from vprbench.catalogue import catalogue, load_route
from vprbench.cli import main

PAGE = (Path(__file__).parents[2] / "docs" / "routes.md").read_text("utf-8")


def block(language: str, start: str = "") -> str:
    blocks = re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    return next(text for text in blocks if text.startswith(start))


def test_two_drives_of_ones_own_become_a_route(tmp_path: Path) -> None:
    for number, day in enumerate(("monday", "friday", "elsewhere")):
        (tmp_path / day / "images").mkdir(parents=True)
        (tmp_path / day / "frames.csv").write_text(block("csv"))
        for frame in range(1, 4):
            image = np.full((20, 40), 10 * number + frame, np.uint8)
            assert cv2.imwrite(str(tmp_path / day / "images" / f"{frame:04d}.png"), image)
    (tmp_path / "my.toml").write_text(block("toml", "# my.toml"))
    route = load_route("my-road", routes=tmp_path / "my.toml")
    assert route.environment == "suburb"
    assert len(route.training) == 1
    # 0.000086 degrees of latitude, 111.2 km each, and 0.000029 of longitude, 73.1 km each.
    assert route.learn.length == pytest.approx(np.hypot(9.56, 2.12), abs=0.02)
    assert np.degrees(route.learn.headings) == pytest.approx([12.5, 12.7, 12.6])


def test_the_other_readers_take_their_examples(tmp_path: Path) -> None:
    (tmp_path / "kitti.toml").write_text(block("toml", "# kitti.toml"))
    known = catalogue(tmp_path / "kitti.toml")
    built_in = catalogue().names()
    readers = {known.entry(name).reader for name in known.names() if name not in built_in}
    assert readers == {"kitti-odometry", "kitti-raw", "street"}


@pytest.mark.parametrize(
    ("file", "readers"),
    [
        ("index", ["index", "index"]),
        ("vpr-bench", ["vpr-bench"]),
        ("utm", ["utm"]),
        ("robotcar", ["robotcar"]),
    ],
)
def test_data_sets_of_others_take_their_examples(tmp_path: Path, file: str, readers: list[str]) -> None:
    (tmp_path / "my.toml").write_text(block("toml", f"# {file}.toml"))
    known, built_in = catalogue(tmp_path / "my.toml"), catalogue().names()
    assert [known.entry(name).reader for name in known.names() if name not in built_in] == readers


def test_gardens_point_runs_as_the_page_says(
    tmp_path: Path, draw_view: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for number in range(12):
        draw_view(tmp_path / "GardensPointWalking" / "day_left" / f"Image{number:03d}.jpg", number)
        draw_view(tmp_path / "GardensPointWalking" / "night_right" / f"Image{number:03d}.jpg", number)
    (tmp_path / "my.toml").write_text(block("toml", "# index.toml"))
    words = ["run", "gardens-point", "cohog", "--routes", str(tmp_path / "my.toml"), "--distance", "2"]
    monkeypatch.setattr(sys, "argv", ["vprbench", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code
    assert "cohog on gardens-point, a place every 2 frames" in capsys.readouterr().out


def test_every_route_that_the_page_names_is_there() -> None:
    named = set(re.findall(r"`(KITTI-[\w-]+)`", PAGE))
    assert named and named <= set(catalogue().names())
