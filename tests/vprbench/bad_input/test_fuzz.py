"""Bytes that anything may have happened to: a file either reads, or its fault is one that the user is told."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from vprbench.entries.files import read_entries
from vprbench.errors import VprbenchError
from vprbench.readers.folder import FolderDrive
from vprbench.readers.kitti import read_motion, read_projection
from vprbench.sweep import parse_sweep
from vprbench.trace import Trace

POSES = b"".join(b"1 0 0 %d.5 0 1 0 0 0 0 1 %d\n" % (frame, frame) for frame in range(4))
TABLE = b"file,time,latitude,longitude\n" + b"".join(b"%d.png,%d.5,49.000%d,8.4\n" % (n, n, n) for n in range(4))
ROUTES = b"""[routes.a]
reader = "folder"
learn = "x"
test = "y"
camera = { fx = 700.0, cx = 300 }
[routes.b]
reader = "kitti-odometry"
learn = "00:0-9"
test = "00:15-24"
"""
SWEEP = b"""routes = ["Street-Wide"]
sampling_distances = [2, 5.0]
seeds = [0, 1]
[agents]
a = { localizer = "cohog", step = 3.0 }
"""

# What is put in the place of something: bytes, and words that files of this kind hold.
WORDS = [b"nan", b"-", b"1e308", b"9" * 30, b"\n", b"\r\n", b'"', b",", b"=", b"[", b"{", b"\xef\xbb\xbf", b"0"]
PIECES = st.one_of(st.binary(max_size=4), st.sampled_from(WORDS))


@st.composite
def mutated(draw: st.DrawFn, whole: bytes) -> bytes:
    """The file with up to three parts cut out, repeated or replaced."""
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(whole)))
        end = draw(st.integers(start, min(len(whole), start + 40)))
        whole = whole[:start] + draw(PIECES | st.just(whole[start:end] * 2)) + whole[end:]
    return whole


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("fuzz")
    (made / "times.txt").write_text("0\n0.1\n0.2\n0.3\n")
    return made


def reads_or_tells(read: Callable[[], object]) -> None:
    """Read; any error but one that the user is told, in one line, fails the test."""
    try:
        read()
    except VprbenchError as error:
        assert len(str(error).splitlines()) == 1


@given(mutated(POSES))
@example(POSES)
def test_pose_files(folder: Path, content: bytes) -> None:
    (folder / "poses.txt").write_bytes(content)
    reads_or_tells(lambda: read_motion(folder / "poses.txt", folder / "times.txt"))


@given(mutated(b"0\n0.1\n0.2\n0.3\n"))
def test_time_files(folder: Path, content: bytes) -> None:
    (folder / "poses4.txt").write_bytes(POSES)
    (folder / "times4.txt").write_bytes(content)
    reads_or_tells(lambda: read_motion(folder / "poses4.txt", folder / "times4.txt"))


@given(mutated(b"P0: 718.8 0 607.1 0 0 718.8 185.2 0 0 0 1 0\nP1: 1 2 3\n"))
def test_calibration_files(folder: Path, content: bytes) -> None:
    (folder / "calib.txt").write_bytes(content)
    reads_or_tells(lambda: read_projection(folder / "calib.txt", "P0"))


@given(mutated(TABLE) | mutated(TABLE.replace(b"latitude,longitude", b"east,north")))
@example(TABLE)
def test_tables_of_ones_own(folder: Path, content: bytes) -> None:
    (folder / "frames.csv").write_bytes(content)
    drive = FolderDrive(folder / "frames.csv")

    def read() -> None:
        drive.need()
        fixes = drive.geodetic
        drive.motion(None if fixes is None else np.asarray(fixes[0]))

    reads_or_tells(read)


@given(mutated(ROUTES))
def test_route_files(folder: Path, content: bytes) -> None:
    (folder / "routes.toml").write_bytes(content)
    reads_or_tells(lambda: [entry.needs(folder) for entry in read_entries(folder / "routes.toml").values()])


@settings(max_examples=50)
@given(mutated(SWEEP))
def test_sweep_files(folder: Path, content: bytes) -> None:
    (folder / "sweep.toml").write_bytes(content)
    reads_or_tells(lambda: list(parse_sweep(folder / "sweep.toml").cells()))


@settings(max_examples=50)
@given(st.data())
def test_traces(folder: Path, data: st.DataObject) -> None:
    rows = np.arange(3)
    right, zero = np.ones(3, bool), np.zeros(3)
    trace = Trace(rows, rows, rows, zero + 0.5, zero, zero, right, right, 0 * rows, 0 * rows, zero, zero)
    trace.save(folder / "trace.parquet")
    whole = (folder / "trace.parquet").read_bytes()
    (folder / "trace.parquet").write_bytes(data.draw(mutated(whole)))
    reads_or_tells(lambda: Trace.load(folder / "trace.parquet"))
