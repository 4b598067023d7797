from __future__ import annotations

import io
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.errors import DataError
from vprbench.fetch.byte_source import LocalFile, WindowedFile
from vprbench.reporting import Report, silent

CONTENT = bytes(range(256)) * 2000


class Memory:
    """Bytes as a source, which counts how often it is read."""

    name, size = "memory", len(CONTENT)

    def __init__(self) -> None:
        self.reads = 0

    def read(self, start: int, stop: int, report: Report = silent) -> bytes:
        assert 0 <= start < stop <= self.size
        self.reads += 1
        return CONTENT[start:stop]

    def close(self) -> None:
        pass


places = st.integers(0, len(CONTENT) + 10)
steps = st.lists(
    st.tuples(places, st.integers(-1, 300_000), st.one_of(st.none(), st.tuples(places, places))), max_size=8
)


@given(steps)
def test_it_reads_as_any_file_does(steps: list[tuple[int, int, tuple[int, int] | None]]) -> None:
    file, truth = WindowedFile(Memory()), io.BytesIO(CONTENT)
    for position, size, window in steps:
        if window is not None and min(window) < min(max(window), len(CONTENT)):
            file.load(min(window), min(max(window), len(CONTENT)))
        assert file.seek(position) == truth.seek(position)
        assert file.read(size) == truth.read(size)
        assert file.tell() == truth.tell()
        assert file.seek(-min(position, 5), io.SEEK_CUR) == truth.seek(-min(position, 5), io.SEEK_CUR)


def test_what_is_in_memory_is_not_read_again() -> None:
    source = Memory()
    file = WindowedFile(source)
    file.load(1000, 200_000)
    for start in range(1000, 190_000, 1000):
        file.seek(start)
        file.read(1000)
    file.load(5000, 6000)
    assert source.reads == 1
    file.seek(-22, io.SEEK_END)
    file.read(22)
    file.seek(-100_000, io.SEEK_END)
    file.read(100)
    assert source.reads == 2


def test_nothing_lies_before_the_start() -> None:
    file = WindowedFile(Memory())
    with pytest.raises(ValueError, match="before the start"):
        file.seek(-1)


def test_a_local_file_is_read_in_parts(tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(CONTENT)
    file = LocalFile(tmp_path / "x")
    assert file.size == len(CONTENT)
    assert file.read(300, 310) == CONTENT[300:310]
    (tmp_path / "x").write_bytes(b"short")
    with pytest.raises(DataError, match=r"x: became shorter while it was read"):
        file.read(200_000, 200_010)
    file.close()
    with pytest.raises(DataError, match=r"cannot be read \(Is a directory\)"):
        LocalFile(tmp_path)
