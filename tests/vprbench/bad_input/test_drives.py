"""Drives broken in every way that disks, downloads and hands break them: one line that names the file, no traceback."""

from __future__ import annotations

import shutil
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

Break = Callable[[Path], None]
Tell = Callable[..., Any]

# PNG: 8 bytes, then the header chunk.
HEADER = slice(12, 29)


def edit(change: Callable[[bytes], bytes]) -> Break:
    def breaks(path: Path) -> None:
        before = path.read_bytes()
        path.write_bytes(change(before))
        assert path.read_bytes() != before

    return breaks


def put(content: bytes) -> Break:
    return edit(lambda _: content)


def swap(old: bytes, new: bytes) -> Break:
    return edit(lambda content: content.replace(old, new, 1))


def line(number: int, text: bytes) -> Break:
    """Another text in one line, counted from 1."""
    return edit(lambda content: b"\n".join([*content.split(b"\n")[: number - 1], text, *content.split(b"\n")[number:]]))


def word(number: int, text: bytes) -> Break:
    """Another word in a file of one line, counted from 0."""
    return edit(lambda content: b" ".join([*content.split()[:number], text, *content.split()[number + 1 :]]))


def picture(depth: type[np.generic], *shape: int) -> Break:
    return put(cv2.imencode(".png", np.ones(shape, depth))[1].tobytes())


def oversized(content: bytes) -> bytes:
    """A PNG whose header, its checksum right, claims 100,000 x 100,000 pixels."""
    header = b"IHDR" + struct.pack(">II", 100_000, 100_000) + content[HEADER][12:]
    return content[:12] + header + struct.pack(">I", zlib.crc32(header)) + content[33:]


def folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def circle(path: Path) -> None:
    """A link to itself, where a file or a folder was."""
    shutil.rmtree(path) if path.is_dir() else path.unlink()
    path.symlink_to(path)


def file(path: Path) -> None:
    shutil.rmtree(path)
    path.touch()


cut = edit(lambda content: content[:-20])
semicolons = edit(lambda content: content.replace(b",", b";").replace(b".", b","))
utf16 = edit(lambda content: content.decode().encode("utf-16"))

SEQUENCE = "dataset/sequences/00"
IMAGE, POSES = f"{SEQUENCE}/image_0/000005.png", "dataset/poses/00.txt"
TIMES, CALIBRATION = f"{SEQUENCE}/times.txt", f"{SEQUENCE}/calib.txt"
ODOMETRY: list[tuple[str, Break, str]] = [
    (IMAGE, cut, "000005.png: the PNG is cut off; fetch the file again"),
    (IMAGE, put(b""), "000005.png: the file is empty; fetch"),
    (IMAGE, put(b"<html>404</html>"), "000005.png: neither PNG nor JPEG; fetch"),
    (IMAGE, edit(oversized), "000005.png: the image cannot be decoded; fetch"),
    (IMAGE, picture(np.uint16, 38, 124), "000005.png: 16 bits a pixel where 8 are due; convert"),
    (IMAGE, picture(np.uint8, 38, 124, 3), "000005.png: colour, where the camera is grey; put the grey image there"),
    (IMAGE, picture(np.uint8, 30, 124), "000005.png: 124x30 pixels where the drive's other frames have 124x38"),
    (IMAGE, Path.unlink, "missing 5. `vprbench fetch Road` gets"),
    (IMAGE, folder, "000005.png: cannot be read (Is a directory)"),
    (IMAGE, circle, "000005.png: cannot be read (Too many levels of symbolic links)"),
    (f"{SEQUENCE}/image_0", circle, "missing 0-9, 15-24. `vprbench fetch Road` gets"),
    (f"{SEQUENCE}/image_0", file, "missing 0-9, 15-24. `vprbench fetch Road` gets"),
    (SEQUENCE, file, "no file"),
    (POSES, swap(b"1 0 0 0.000000e+00 0 1", b"nan 0 0 0 0 1"), "00.txt, line 1: 'nan' is not a finite number"),
    (POSES, line(6, b"1 0 0 1e300 0 1 0 0 0 0 1 5"), "00.txt, line 6: '1e300' is too large a number"),
    (POSES, line(6, b"1 0 0 1e9 0 1 0 0 0 0 1 5"), "frame 5: 10000000000 m/s since the frame before; check"),
    (POSES, line(6, b"0 1 0 0 1 0 0 0 0 0 1 5"), "00.txt, line 6: not a pose, since its 3 x 3 part is no rotation"),
    (POSES, line(6, b"2 0 0 0 0 1 0 0 0 0 1 5"), "00.txt, line 6: not a pose, since its 3 x 3 part is no rotation"),
    (POSES, edit(lambda c: b"\n".join(c.split(b"\n")[:20])), "times.txt: 30 times for the 20 poses in"),
    (POSES, edit(lambda c: c + c.split(b"\n")[-2]), "times.txt: 30 times for the 31 poses in"),
    (POSES, edit(lambda c: c[:-40]), "00.txt, line 30: "),
    (POSES, put(b""), "00.txt: the file is empty"),
    (POSES, utf16, "00.txt, line 1: not UTF-8; save"),
    (POSES, line(3, b"1 0 0 0 0 1 0 0 0 0 1 \0"), "00.txt, line 3: holds a NUL"),
    (POSES, folder, "no file"),
    (POSES, circle, "no file"),
    (TIMES, line(6, b"0.4"), "times.txt, line 6: the time is not after the one before"),
    (TIMES, line(1, b"-5"), "times.txt, line 1: the time -5 is not within 0 to 1e+10 s"),
    (TIMES, line(30, b"1e18"), "times.txt, line 30: the time 1e+18 is not within 0 to 1e+10 s"),
    (TIMES, line(6, b"0,5"), "times.txt, line 6: '0,5' is not a finite number"),
    (TIMES, line(6, b""), "times.txt, line 6: 0 numbers where 1 are due"),
    (CALIBRATION, put(b""), "calib.txt: no line 'P0'"),
    (CALIBRATION, put(bytes(range(256))), "calib.txt, line 2: not UTF-8"),
    (CALIBRATION, put(b"P0: 1e300 0 60 0 0 1 0 0 0 0 1 0"), "124 pixels wide, but fx is 1e+300: not the calibration"),
    (CALIBRATION, put(b"P0: 1e-9 0 60 0 0 1 0 0 0 0 1 0"), "124 pixels wide, but fx is 1e-09: not the calibration"),
    (CALIBRATION, Path.unlink, "no file"),
]

FIX = "2011_10_03/2011_10_03_drive_0027_sync/oxts/data/0000000005.txt"
STAMPS = "2011_10_03/2011_10_03_drive_0027_sync/image_00/timestamps.txt"
RAW: list[tuple[str, Break, str]] = [
    (FIX, word(0, b"91"), "0000000005.txt: latitude 91 is not within 90 degrees"),
    (FIX, word(1, b"-181"), "0000000005.txt: longitude -181 is not within 180 degrees"),
    (FIX, word(0, b"49,0"), "0000000005.txt, line 1: '49,0' is not a finite number"),
    (FIX, word(0, b"49.9"), "frame 5: 1000"),  # 0.9 degrees, 100 km, in a tenth of a second
    (FIX, word(5, b"90"), "0000000005.txt: yaw 90 is not within a turn, 6.28 rad"),
    (FIX, put(b""), "0000000005.txt: the file is empty"),
    (FIX, circle, "0000000005.txt: cannot be read (Too many levels of symbolic links)"),
    (FIX, Path.unlink, "missing 5. `vprbench fetch Road` gets"),
    (STAMPS, line(6, b"now"), "timestamps.txt, line 6: 'now' is not a time, for example 2011-10-03"),
    (STAMPS, line(6, b"2011"), "timestamps.txt, line 6: '2011' is not a time"),
    (STAMPS, line(6, b"2011-13-03 12:55:00.5"), "timestamps.txt, line 6: '2011-13-03 12:55:00.5' is not a time"),
    (STAMPS, line(6, b"2011-10-03 12:55:00.5+02:00"), "timestamps.txt, line 6: "),
    (STAMPS, put(b""), "timestamps.txt: 0 lines, too few for frame 9"),
]

TABLE, OWN_IMAGE = "day1/frames.csv", "day1/img/1.png"
OWN: list[tuple[str, Break, str]] = [
    (TABLE, swap(b"heading_deg", b"yaw"), "frames.csv, line 1: unknown column 'yaw'"),
    (TABLE, swap(b"49.00001", b"149.0"), "frames.csv, line 3: latitude 149 is not within 90 degrees"),
    (TABLE, semicolons, "frames.csv, line 1: separated by semicolons; separate the columns by commas"),
    (TABLE, edit(lambda c: c.replace(b",", b"\t")), "frames.csv, line 1: separated by tabs"),
    (TABLE, swap(b"49.00001", b'"49,00001"'), "frames.csv, line 3: latitude is '49,00001', not a finite number; write"),
    (TABLE, swap(b"49.00001", b"49,00001"), "frames.csv, line 3: 6 values for 5 columns; write decimals with a point"),
    (TABLE, swap(b"img/1", b"im\xe9/1"), "frames.csv, line 3: not UTF-8; save the file as text in UTF-8"),
    (TABLE, swap(b"img/1", b"im\0/1"), "frames.csv, line 3: holds a NUL"),
    (TABLE, utf16, "frames.csv, line 1: not UTF-8"),
    (TABLE, put(b""), "frames.csv: the file is empty"),
    (TABLE, edit(lambda c: c.split(b"\n")[0]), "frames.csv: 0 frames, and a drive has at least two"),
    (TABLE, swap(b"2.0,", b"1.0,"), "frames.csv, line 4: the time is not after the one before"),
    (TABLE, swap(b"0.0,", b"-3,"), "frames.csv, line 2: the time -3 is not within 0 to 1e+10 s"),
    (TABLE, swap(b"3.0,", b"1e300,"), "frames.csv, line 5: time is '1e300', too large a number"),
    (TABLE, swap(b"img/1.png", b""), "frames.csv, line 3: no image; give its file"),
    (TABLE, swap(b"img/1.png", b"x" * 5000), "missing 1. Put each image where"),
    (TABLE, folder, "frames.csv, a file that is not there. Put each image"),
    (TABLE, circle, "frames.csv, a file that is not there. Put each image"),
    ("day1", circle, "frames.csv, a file that is not there. Put each image"),
    (OWN_IMAGE, put(b""), "1.png: the file is empty; fetch"),
    (OWN_IMAGE, folder, "1.png: cannot be read (Is a directory)"),
    (OWN_IMAGE, circle, "1.png: cannot be read (Too many levels of symbolic links)"),
    (OWN_IMAGE, Path.unlink, "3 of 4 are in"),
    (OWN_IMAGE, put(cv2.imencode(".jpg", np.ones((100, 200), np.uint8))[1].tobytes()[:-80]), "1.png: the JPEG is cut"),
]

CASES = [(layout, *case) for layout, cases in [("odometry", ODOMETRY), ("raw", RAW), ("own", OWN)] for case in cases]


@pytest.mark.parametrize(("layout", "path", "breaks", "said"), CASES)
def test_what_is_broken_is_named(
    request: pytest.FixtureRequest, tell: Tell, layout: str, path: str, breaks: Break, said: str
) -> None:
    here: Path = request.getfixturevalue(layout)
    breaks(here / path)
    done = tell("run", "Road", "thumbnail", "--data", here, "--routes", here / "routes.toml")
    assert said in done.err
    assert done.err.startswith("vprbench: ")
    assert len(done.err.splitlines()) == 1
    assert (done.code, done.out) == (3, "")


TEXTS = [("odometry", POSES), ("odometry", TIMES), ("raw", STAMPS), ("own", TABLE), ("own", "routes.toml")]


@pytest.mark.parametrize(("layout", "path"), TEXTS)
@pytest.mark.parametrize(("old", "new"), [(b"", b"\xef\xbb\xbf"), (b"\n", b"\r\n")], ids=["mark", "line ends"])
def test_a_byte_order_mark_and_the_line_ends_of_windows_are_no_fault(
    request: pytest.FixtureRequest, tell: Tell, layout: str, path: str, old: bytes, new: bytes
) -> None:
    here: Path = request.getfixturevalue(layout)
    edit(lambda content: content.replace(old, new, -1 if old else 1))(here / path)
    done = tell("run", "Road", "thumbnail", "--data", here, "--routes", here / "routes.toml")
    assert (done.code, done.err) == (0, "")
    assert "thumbnail on Road" in done.out
