from __future__ import annotations

from pathlib import Path

import pytest

from vprbench.availability import Availability, need_of
from vprbench.errors import DataError


def test_a_need_knows_what_is_there(tmp_path: Path) -> None:
    for frame in (1, 2, 5):
        (tmp_path / f"{frame}.png").touch()
    need = need_of("my drive", tmp_path, {i: (tmp_path / f"{i}.png",) for i in range(1, 8)}, (), "Drive it.")
    assert need.missing == (3, 4, 6, 7)
    assert str(need) == f"frames 1-7 of my drive: 3 of 7 are in {tmp_path}, missing 3-4, 6-7"


def test_a_frame_needs_all_of_its_files(tmp_path: Path) -> None:
    (tmp_path / "image").touch()
    need = need_of("x", tmp_path, {0: (tmp_path / "image", tmp_path / "elsewhere" / "fix")}, (), "")
    assert need.missing == (0,)


def test_require_says_everything_once(tmp_path: Path) -> None:
    frames = {i: (tmp_path / f"{i}.png",) for i in range(3)}
    needs = tuple(need_of(source, tmp_path, frames, (tmp_path / "poses",), "Fetch it.") for source in ("A", "B"))
    there = Availability("R-1", needs)
    assert (there.present, there.missing, there.complete) == (0, 6, False)
    with pytest.raises(DataError) as error:
        there.require()
    text = str(error.value)
    assert text.startswith("R-1 needs frames 0-2 of A: 0 of 3 are in")
    assert "; and frames 0-2 of B" in text
    assert f"no file {tmp_path / 'poses'}" in text
    assert text.count("Fetch it.") == 1
    assert "\n" not in text


def test_what_is_public_names_the_command_that_gets_it(tmp_path: Path) -> None:
    frames = {i: (tmp_path / f"{i}.png", tmp_path / f"{i}.txt") for i in range(2)}
    (tmp_path / "0.png").touch()
    own, public = (need_of("A", tmp_path, frames, (tmp_path / "p",), "", public=public) for public in (False, True))
    assert [path.name for path in public.files] == ["0.png", "0.txt", "1.png", "1.txt", "p"]
    assert Availability("R-1", (own,)).hint == ""
    assert Availability("R-1", (own, public)).hint == "`vprbench fetch R-1` gets what is missing."
    for path in public.files:
        path.touch()
    there = need_of("A", tmp_path, frames, (tmp_path / "p",), "", public=True)
    assert Availability("R-1", (there,)).hint == ""


def test_a_missing_table_alone_is_a_want(tmp_path: Path) -> None:
    (tmp_path / "0.png").touch()
    need = need_of("A", tmp_path, {0: (tmp_path / "0.png",)}, (tmp_path / "poses",), "Fetch it.")
    there = Availability("R-1", (need,))
    assert (there.present, there.missing, there.complete) == (1, 0, False)
    with pytest.raises(DataError, match=r"no file .*poses"):
        there.require()


def test_a_route_without_needs_is_complete() -> None:
    Availability("Street-Wide", ()).require()
