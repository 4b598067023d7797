"""Archives that are broken, or made to harm: nothing is written but whole files, and only where they belong."""

from __future__ import annotations

import stat
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.vprbench.fetch.conftest import Tell, World

POSES = "data_odometry_poses.zip"
MEMBER = "dataset/poses/00.txt"

# Where the fields of an entry lie in the directory: flags, CRC-32, sizes packed and unpacked, and the member's place.
FLAGS, CRC, PACKED, SIZE, PLACE = 8, 16, 20, 24, 42


def named(name: str, mode: int = 0) -> zipfile.ZipInfo:
    """A member of any name whatever, which the constructor would tidy up."""
    info = zipfile.ZipInfo()
    info.filename, info.external_attr = name, mode << 16
    return info


def entry(archive: Path, field: int, form: str, value: int) -> None:
    """Overwrite a field of the first entry of an archive's directory."""
    data = bytearray(archive.read_bytes())
    struct.pack_into(form, data, data.index(b"PK\x01\x02") + field, value)
    archive.write_bytes(data)


@pytest.fixture
def poses(world: World) -> Path:
    """The archive of poses, for tests to spoil."""
    return world.server.folder / POSES


@pytest.fixture
def refused(world: World, tell: Tell) -> Callable[[], str]:
    """Fetches, expects that nothing was written, and says why."""

    def why() -> str:
        fault = tell.fetch().fault
        assert world.written() == {} and world.sound()
        return fault

    return why


@pytest.mark.parametrize(
    "name",
    ["../escaped", "dataset/../../escaped", "/tmp/escaped", "C:/escaped", "..\\escaped", "dataset\\x", "a\0b", ".."],
)
def test_a_name_that_leads_out_spoils_its_archive(poses: Path, refused: Callable[[], str], name: str) -> None:
    with zipfile.ZipFile(poses, "a") as zipped:
        zipped.writestr(named(name), "harm")
    assert f"/{POSES}: holds {name!r}, which leads out of the folder it is for: not to be trusted" in refused()


@pytest.mark.parametrize("name", ["dataset/..00.txt", "dataset/poses/00..txt", "...", "dataset/"])
def test_dots_alone_do_no_harm(poses: Path, tell: Tell, name: str) -> None:
    with zipfile.ZipFile(poses, "a") as zipped:
        zipped.writestr(named(name), "")
    assert tell.fetch().code == 0


def test_a_link_is_not_followed(poses: Path, refused: Callable[[], str]) -> None:
    with zipfile.ZipFile(poses, "w") as zipped:
        zipped.writestr(named(MEMBER, stat.S_IFLNK | 0o777), "/etc/passwd")
    assert f"{MEMBER} is a link, not a file; name another --source" in refused()


def test_of_two_members_neither_is_taken(poses: Path, refused: Callable[[], str]) -> None:
    with zipfile.ZipFile(poses, "a") as zipped, pytest.warns(UserWarning, match="Duplicate"):
        zipped.writestr(named(MEMBER), "other poses")
    assert f"{MEMBER} is in it twice" in refused()


@pytest.mark.parametrize(
    ("field", "form", "value", "said"),
    [
        (FLAGS, "<H", 1, "is encrypted"),
        (SIZE, "<I", 3 << 30, "is said to have 3072 MiB, too much for a file of its kind"),
        (PACKED, "<I", 3 << 30, "is said to lie beyond the archive's end"),
        (PLACE, "<I", 3 << 30, "is said to lie beyond the archive's end"),
    ],
)
def test_what_the_directory_cannot_mean_is_refused(
    poses: Path, refused: Callable[[], str], field: int, form: str, value: int, said: str
) -> None:
    entry(poses, field, form, value)
    assert f"{POSES}: {MEMBER} {said}; name another --source" in refused()


@pytest.mark.parametrize(
    ("field", "form", "value", "said"),
    [
        (CRC, "<I", 7, "Bad CRC-32"),
        (SIZE, "<I", 100, "Bad CRC-32"),
        (SIZE, "<I", 60_000_000, "bytes where 60000000 are due"),
        (PACKED, "<I", 5, ""),
        (PLACE, "<I", 3, "Bad magic number"),
        (10, "<H", 99, "compression"),
    ],
)
def test_a_damaged_member_is_not_written(
    world: World, poses: Path, tell: Tell, field: int, form: str, value: int, said: str
) -> None:
    entry(poses, field, form, value)
    fault = tell.fetch().fault
    assert f"{POSES}: {MEMBER} is damaged (" in fault and said in fault and "--source" in fault
    assert MEMBER not in world.written() and world.sound()


def test_a_bomb_does_not_go_off(poses: Path, tell: Tell, world: World) -> None:
    with zipfile.ZipFile(poses, "w", zipfile.ZIP_DEFLATED) as zipped:
        zipped.writestr(MEMBER, bytes(100_000_000))
    assert poses.stat().st_size < 200_000
    assert "is said to have 95 MiB" in tell.fetch().fault
    entry(poses, SIZE, "<I", 1000)
    assert f"{MEMBER} is damaged" in tell.fetch().fault
    assert MEMBER not in world.written() and world.sound()


@pytest.mark.parametrize("content", [b"", b"<html>not here</html>", b"PK\x05\x06" + bytes(17), bytes(200_000)])
def test_what_is_no_zip_is_refused(poses: Path, refused: Callable[[], str], content: bytes) -> None:
    poses.write_bytes(content)
    fault = refused()
    assert POSES in fault and ("not a zip archive, or not all of one" in fault or "is empty" in fault)


def test_a_part_of_an_archive_is_refused(world: World, refused: Callable[[], str]) -> None:
    archive = world.server.folder / "data_odometry_gray.zip"
    with archive.open("r+b") as file:
        file.truncate(archive.stat().st_size - 1000)
    assert "data_odometry_gray.zip: not a zip archive, or not all of one" in refused()


def test_a_directory_of_gigabytes_is_not_read(world: World, refused: Callable[[], str]) -> None:
    archive = world.server.folder / "data_odometry_gray.zip"
    with archive.open("r+b") as file:
        file.seek(-98, 2)
        record = bytearray(file.read(56))
        assert record.startswith(b"PK\x06\x06")
        size, start = struct.unpack_from("<QQ", record, 40)
        struct.pack_into("<QQ", record, 40, size + (4 << 30), start - (4 << 30))
        file.seek(-98, 2)
        file.write(record)
    assert "4096 MiB in one piece: not an archive of this kind" in refused()
