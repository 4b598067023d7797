"""What goes wrong on the way: each is told in one line, and leaves nothing but whole files."""

from __future__ import annotations

import os
import shutil
import socket
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.vprbench.fetch.conftest import Fault, Handler, Tell, World

GREY = "data_odometry_gray.zip"


def frames_only(fault: Fault) -> Fault:
    """The fault where frames are asked for, not the archive's size or directory."""

    def only(handler: Handler, start: int, stop: int) -> bool:
        asked = [path for path, _, _ in handler.server.log if path.endswith(GREY)]
        return handler.path.endswith(GREY) and len(asked) > 2 and fault(handler, start, stop)

    return only


def drop(handler: Handler, start: int, stop: int) -> bool:
    """Hang up without an answer."""
    handler.connection.shutdown(socket.SHUT_RDWR)
    handler.close_connection = True
    return True


def stumble(handler: Handler, start: int, stop: int) -> bool:
    """Hang up after 5,000 bytes."""
    handler.part(start, stop, sent=5000)
    return True


def whole(handler: Handler, start: int, stop: int) -> bool:
    """Begin to send the whole file."""
    handler.send_response(200)
    handler.send_header("Content-Length", str(5 << 30))
    handler.end_headers()
    handler.wfile.write(b"PK")
    handler.close_connection = True
    return True


def answering(status: int) -> Fault:
    """Answer with a status alone."""

    def answer(handler: Handler, start: int, stop: int) -> bool:
        handler.send_error(status)
        return True

    return answer


def saying(key: str, value: str | Callable[[int, int], str]) -> Fault:
    """Send what is asked for, with another header."""

    def answer(handler: Handler, start: int, stop: int) -> bool:
        handler.part(start, stop, headers={key: value if isinstance(value, str) else value(start, stop)})
        return True

    return answer


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        (frames_only(drop), "dropped 5 times at byte "),
        (frames_only(answering(503)), "dropped 5 times at byte "),
        (drop, "cannot be reached ("),
        (answering(404), "the server answers 404 Not Found; check the address, or name another --source"),
        (answering(403), "the server answers 403 Forbidden"),
        (whole, "the server refuses to send parts of a file (range requests); download the whole"),
        (frames_only(whole), "the server refuses to send parts of a file"),
        (frames_only(saying("ETag", '"2"')), "changed while it was read (has another ETag or date)"),
        (frames_only(saying("Last-Modified", "now")), "changed while it was read (has another ETag or date)"),
        (frames_only(answering(416)), "changed while it was read (is shorter)"),
        (
            frames_only(saying("Content-Range", lambda start, stop: f"bytes {start}-{stop - 1}/{7 << 30}")),
            f"and has {7 << 30}); run the same command again: it goes on from there",
        ),
        (
            frames_only(saying("Content-Range", lambda start, stop: f"bytes 0-{stop - start - 1}/{5 << 30}")),
            "the server sends 'bytes 0-",
        ),
        (saying("Content-Range", "bytes */*"), "asked for byte 0, the server sends 'bytes */*'"),
    ],
)
def test_a_servers_fault_is_told(world: World, tell: Tell, fault: Fault, said: str) -> None:
    world.server.fault = fault
    told = tell.fetch().fault
    assert told.startswith(f"vprbench: {world.server.url(GREY)}: ") and said in told
    assert world.written() == {}


def test_nobody_is_there(world: World, tell: Tell) -> None:
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        told = tell.fetch(f"http://127.0.0.1:{unused.getsockname()[1]}/").fault
    assert "cannot be reached" in told and "refused" in told and "--source" in told
    assert tell.waits == [1.0, 2.0, 4.0, 8.0]


def test_what_drops_is_taken_up_where_it_ended(world: World, tell: Tell) -> None:
    world.server.fault = frames_only(stumble)
    assert tell.fetch().code == 0
    assert set(world.written()) == set(world.wanted) and world.sound()
    asked = [(start, stop) for path, start, stop in world.server.log if path.endswith(GREY)][2:]
    steps = [after[0] - before[0] for before, after in pairwise(asked) if after[1] == before[1]]
    assert len(steps) > 10 and set(steps) == {5000}
    assert set(tell.waits) == {1.0}


def test_what_came_before_the_fault_stays(world: World, tell: Tell) -> None:
    def late(handler: Handler, start: int, stop: int) -> bool:
        return start > 5 << 30 and drop(handler, start, stop)

    world.server.fault = frames_only(late)
    assert "dropped 5 times" in tell.fetch().fault
    assert sorted(world.written()) == sorted(world.wanted[:14]) and world.sound()
    world.server.fault = None
    assert tell.fetch().code == 0
    assert set(world.written()) == set(world.wanted) and world.sound()


def flood(handler: Handler, start: int, stop: int) -> bool:
    """Send what is asked for, and then no end of it."""
    handler.part(start, stop, headers={"Content-Length": str(1 << 40)})
    with suppress(OSError):
        while True:
            handler.wfile.write(bytes(1 << 16))
    handler.close_connection = True
    return True


def test_what_was_not_asked_for_is_not_read(world: World, tell: Tell) -> None:
    world.server.fault = flood
    assert tell.fetch().code == 0
    assert set(world.written()) == set(world.wanted) and world.sound()


def test_passwords_and_tokens_are_not_told(world: World, tell: Tell) -> None:
    world.server.fault = answering(404)
    secret = world.server.url(GREY).replace("http://", "http://me:secret@") + "?token=secret"
    done = tell.fetch(secret)
    assert world.server.log[0][0] == f"/{GREY}?token=secret"
    assert world.server.url(GREY) in done.fault and "secret" not in done.fault


@pytest.mark.parametrize("target", ["ftp://127.0.0.1/x.zip", "file:///etc/passwd"])
def test_a_redirection_elsewhere_than_to_the_web_is_refused(world: World, tell: Tell, target: str) -> None:
    world.server.fault = redirecting(target)
    assert f"redirects to {target}, which is not http or https; refused" in tell.fetch().fault


def test_a_redirection_to_nowhere_is_told(world: World, tell: Tell) -> None:
    world.server.fault = redirecting("http://[x/")
    assert "redirects to 'http://[x/', which is no address" in tell.fetch().fault


def test_redirections_are_followed_but_not_for_ever(world: World, tell: Tell) -> None:
    world.server.fault = redirecting("/data_odometry_poses.zip")
    assert "redirects more than 5 times" in tell.fetch().fault

    def moved(handler: Handler, start: int, stop: int) -> bool:
        return not handler.path.startswith("/now/") and redirecting(f"/now{handler.path}")(handler, start, stop)

    (world.server.folder / "now").mkdir()
    for archive in world.server.folder.glob("*.zip"):
        archive.rename(archive.parent / "now" / archive.name)
    world.server.fault = moved
    assert tell.fetch().code == 0
    assert set(world.written()) == set(world.wanted) and world.sound()


def redirecting(target: str) -> Fault:
    """Send the client elsewhere."""

    def answer(handler: Handler, start: int, stop: int) -> bool:
        handler.send_response(302)
        handler.send_header("Location", target)
        handler.send_header("Content-Length", "0")
        handler.end_headers()
        return True

    return answer


def test_a_full_disk_is_told_before_anything_is_fetched(
    world: World, tell: Tell, monkeypatch: pytest.MonkeyPatch
) -> None:
    usage = shutil.disk_usage(world.root)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage._replace(free=1000))
    told = tell.fetch().fault
    assert f"{world.root}: 0." in told and "MB are needed and 0.0 MB are free; make room" in told
    assert world.written() == {}
    assert len(world.server.log) == 6


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no disk that is full")
def test_a_disk_that_fills_up_on_the_way_is_told(world: World, tell: Tell) -> None:
    frame = world.root / world.wanted[5]

    def fill(handler: Handler, start: int, stop: int) -> bool:
        (frame.parent / f".{frame.name}.{os.getpid()}.tmp").symlink_to("/dev/full")
        return False

    world.server.fault = frames_only(fill)
    assert tell.fetch().fault == (
        f"vprbench: {frame}: the disk is full; make room and run the same command again: it goes on from there"
    )
    assert sorted(world.written()) == sorted(world.wanted[:5]) and world.sound()


def test_a_root_that_cannot_be_written_is_told_before_anything_is_fetched(world: World, tell: Tell) -> None:
    (world.root / "dataset").mkdir()
    (world.root / "dataset" / "poses").write_text("in the way")
    asked = tell.fetch()
    assert f"{world.root}/dataset/poses" in asked.fault and "directory" in asked.fault.lower()
    assert list(world.written()) == ["dataset/poses"]
    (world.root / "dataset" / "poses").unlink()
    (world.root / "dataset" / "sequences").symlink_to("sequences")
    assert "symbolic links" in tell.fetch().fault
