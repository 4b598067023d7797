"""Route and sweep files that are no TOML, no text or no question, given to every command that reads them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Tell = Callable[..., Any]

COMMANDS = {
    "run": ["run", "Road", "thumbnail", "--routes", "routes.toml"],
    "list": ["list", "routes", "--routes", "routes.toml"],
    "fit": ["fit", "log-polar", "--route", "Road", "--routes", "routes.toml"],
    "sweep": ["sweep", "answers.toml", "--dry-run"],
}

# Whatever the file, these are no TOML that anyone can read.
FILES: list[tuple[bytes, str]] = [
    (b'x = "\xe9"', "{}, line 1: not UTF-8; save the file as text in UTF-8"),
    ('x = "1"'.encode("utf-16"), "{}, line 1: not UTF-8"),
    (b"a = 1\nb = \0\n", "{}, line 2: holds a NUL"),
    (b"a = 1\nb = = 2\n", "{}: not TOML: Invalid value (at line 2, column 5)"),
    (b"a = " + b"9" * 5000, "{}: not TOML: Exceeds the limit"),
    (b"a = " + b"[" * 3000, "{}: not TOML that can be read: brackets within brackets too deep"),
]

ROUTES: list[tuple[str, str, str]] = [
    ("82.0", "1e-308", "200 pixels wide, but fx is "),
    ("82.0", "inf", "routes.toml: routes.Road.camera.field_of_view_deg: should be a finite number, not inf"),
    ('"day1"', '"~no-such-user/day1"', "routes.toml: routes.Road: ~no-such-user/day1: there is no such user's folder"),
    ('"day1"', '"day\\u00001"', "frames.csv, a file that is not there"),
    ('"day1"', "2026-01-01", "routes.toml: routes.Road.learn: "),
    ('"day2"', '"day1"', "share the image"),
    ("learn", "heading_noise_deg = 1e308\nlearn", "routes.Road.heading_noise_deg: should be less than or equal to 360"),
]


@pytest.fixture
def here(own: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with a question about the road."""
    monkeypatch.chdir(own)
    return own


def assert_told(done: Any, said: str) -> None:  # noqa: ANN401 - the conftest's Told
    assert said in done.err
    assert len(done.err.splitlines()) == 1
    assert done.code in (2, 3)


@pytest.mark.parametrize(("content", "said"), FILES)
@pytest.mark.parametrize("command", ["run", "sweep"])
def test_what_is_no_toml_is_told(here: Path, tell: Tell, command: str, content: bytes, said: str) -> None:
    name = "answers.toml" if command == "sweep" else "routes.toml"
    (here / name).write_bytes(content)
    assert_told(tell(*COMMANDS[command]), said.format(name))
    assert not (here / "runs").exists()


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("kind", ["gone", "folder", "circle"])
def test_a_routes_file_that_is_none_is_told_by_every_command(here: Path, tell: Tell, command: str, kind: str) -> None:
    path = here / "routes.toml"
    path.unlink()
    if kind == "folder":
        path.mkdir()
    if kind == "circle":
        path.symlink_to(path)
    assert_told(tell(*COMMANDS[command]), "routes.toml: cannot be read (")


@pytest.mark.parametrize(("old", "new", "said"), ROUTES)
def test_a_route_that_cannot_be_is_told(here: Path, tell: Tell, old: str, new: str, said: str) -> None:
    text = (here / "routes.toml").read_text()
    assert old in text
    (here / "routes.toml").write_text(text.replace(old, new, 1))
    assert_told(tell(*COMMANDS["run"]), said)


@pytest.mark.parametrize("command", COMMANDS)
def test_a_broken_drive_is_told_by_every_command(here: Path, tell: Tell, command: str) -> None:
    table = here / "day2" / "frames.csv"
    table.write_text(table.read_text().replace("49.00002", "49.0x"))
    done = tell(*COMMANDS[command])
    if command == "list" or command == "sweep":  # which reads no further than the names of the images
        assert done.code == 0
    else:
        assert_told(done, "day2/frames.csv, line 4: latitude is '49.0x', not a finite number")


@pytest.mark.parametrize("kind", ["file", "circle", "nowhere", "~no-such-user"])
def test_a_data_root_that_is_none_is_told(here: Path, tell: Tell, kind: str) -> None:
    root = here / "data"
    if kind == "file":
        root.touch()
    if kind == "circle":
        root.symlink_to(root)
    given = kind if kind.startswith("~") else root
    assert_told(
        tell(*COMMANDS["run"], "--data", given), "no such user" if kind.startswith("~") else "which is not a folder"
    )
