"""Archives with bytes changed anywhere: what is read is right, or the archive is refused."""

from __future__ import annotations

import io
import zipfile
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.errors import DataError
from vprbench.fetch.contents import Contents
from vprbench.reporting import Report, silent

CONTENT = {
    f"{name}.txt": np.random.default_rng(name).integers(65, 70, 300).astype(np.uint8).tobytes() for name in range(3)
}


def packed(form: int) -> bytes:
    """An archive of that content."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", form) as zipped:
        for name, data in CONTENT.items():
            zipped.writestr(name, data)
    return buffer.getvalue()


ARCHIVES = [packed(zipfile.ZIP_STORED), packed(zipfile.ZIP_DEFLATED)]


class Memory:
    """An archive in memory."""

    name = "memory.zip"

    def __init__(self, data: bytes) -> None:
        self.data, self.size = data, len(data)

    def read(self, start: int, stop: int, report: Report = silent) -> bytes:
        assert 0 <= start <= stop <= self.size
        return self.data[start:stop]

    def close(self) -> None:
        pass


@pytest.mark.parametrize("archive", ARCHIVES, ids=["stored", "deflated"])
@given(data=st.data())
def test_no_damage_goes_unseen(archive: bytes, data: st.DataObject) -> None:
    spoilt = bytearray(archive)
    for _ in range(data.draw(st.integers(1, 3))):
        # The directory is at the end, and has most to go wrong.
        place = data.draw(st.integers(0, len(spoilt) - 1) | st.integers(len(spoilt) - 200, len(spoilt) - 1))
        spoilt[place] = data.draw(st.integers(0, 255))
    if data.draw(st.booleans()):
        del spoilt[data.draw(st.integers(0, len(spoilt))) :]
    with suppress(DataError):
        contents = Contents(Memory(bytes(spoilt)))
        for name, original in CONTENT.items():
            info = contents.find(name)
            assert info is None or contents.read(info) == original


@pytest.mark.parametrize("archive", ARCHIVES, ids=["stored", "deflated"])
def test_without_damage_everything_is_read(archive: bytes) -> None:
    contents = Contents(Memory(archive))
    for name, original in CONTENT.items():
        info = contents.find(name)
        assert info is not None and contents.read(info) == original
    assert contents.find("3.txt") is None
