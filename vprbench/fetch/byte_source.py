"""Files of which parts can be read, near or far, and the seekable file over one that `zipfile` works on."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Protocol

from vprbench.errors import DataError
from vprbench.reporting import Report, silent

__all__ = ["ByteSource", "LocalFile", "WindowedFile"]

# Bytes. The end of an archive holds its tables' whereabouts, at most 64 KiB of comment after them: one read has all.
_TAIL = 1 << 17

# Bytes. More is never read at once: KITTI's largest table of contents has some 90,000 lines of about 100 bytes.
_MOST = 1 << 28


class ByteSource(Protocol):
    """A file of known size, any part of which can be read."""

    name: str
    size: int

    def read(self, start: int, stop: int, report: Report = silent) -> bytes:
        """All bytes from `start` to before `stop`; DataError where they cannot be had."""
        ...

    def close(self) -> None:
        """Let go of it."""
        ...


class LocalFile:
    """A file on this machine.

    Attributes:
        name: its path, for messages.
        size: bytes.
    """

    def __init__(self, path: Path) -> None:
        self.name = str(path)
        try:
            self._file = path.open("rb")
        except OSError as error:
            raise DataError(f"{path}: cannot be read ({error.strerror})") from error
        self.size = self._file.seek(0, io.SEEK_END)

    def read(self, start: int, stop: int, report: Report = silent) -> bytes:
        """All bytes from `start` to before `stop`."""
        try:
            self._file.seek(start)
            data = self._file.read(stop - start)
        except OSError as error:
            raise DataError(f"{self.name}: cannot be read ({error.strerror})") from error
        if len(data) < stop - start:
            raise DataError(f"{self.name}: became shorter while it was read; run the same command again")
        report("read", len(data), len(data))
        return data

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class WindowedFile:
    """A source as a seekable file, of which one stretch is in memory at a time; what lies outside is read on demand."""

    def __init__(self, source: ByteSource) -> None:
        self.source = source
        self._start, self._window, self._position = 0, b"", 0

    def load(self, start: int, stop: int, report: Report = silent) -> None:
        """Have the bytes from `start` to before `stop` in memory; DataError where that is more than any file needs."""
        if self._start <= start and stop <= self._start + len(self._window):
            report("read", stop - start, stop - start)
            return
        if stop - start > _MOST:
            raise DataError(f"{self.source.name}: {(stop - start) >> 20} MiB in one piece: not an archive of this kind")
        self._start, self._window = start, self.source.read(start, stop, report)

    def seekable(self) -> bool:
        """It is."""
        return True

    def tell(self) -> int:
        """Where the next byte is read."""
        return self._position

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """Move to where the next byte is to be read; ValueError before the start."""
        base = {io.SEEK_SET: 0, io.SEEK_CUR: self._position, io.SEEK_END: self.source.size}[whence]
        if base + offset < 0:
            raise ValueError(f"byte {base + offset} lies before the start")
        self._position = base + offset
        return self._position

    def read(self, size: int = -1) -> bytes:
        """The next bytes, at most so many, or all that are left; fewer only where the source ends."""
        start, end = self._position, self.source.size
        stop = end if size < 0 else min(start + size, end)
        if stop <= start:
            return b""
        if start < self._start or stop > self._start + len(self._window):
            first = min(start, max(end - _TAIL, 0))
            self.load(first, min(max(stop, first + _TAIL), end))
        self._position = stop
        return self._window[start - self._start : stop - self._start]
