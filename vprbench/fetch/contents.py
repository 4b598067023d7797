"""What a zip archive holds, read from the directory at its end, and the content of single members.

Members are asked for by names that we make up, and written where we say: no name in an archive ever becomes a path.
"""

from __future__ import annotations

import stat
import struct
import zipfile
import zlib
from collections import Counter
from functools import cached_property

from vprbench.errors import DataError
from vprbench.fetch.byte_source import ByteSource, WindowedFile
from vprbench.fetch.names import leads_out
from vprbench.reporting import Report, silent

__all__ = ["Contents"]

# Bytes; the largest files of KITTI have about one million. Our choice.
_LARGEST = 1 << 26

_FAULTS = (
    zipfile.BadZipFile,
    NotImplementedError,
    RuntimeError,
    EOFError,
    ValueError,
    OverflowError,
    struct.error,
    zlib.error,
)


class Contents:
    """The members of one archive.

    Attributes:
        source: the archive.
    """

    def __init__(self, source: ByteSource) -> None:
        self.source = source
        self._file = WindowedFile(source)
        try:
            self._zip = zipfile.ZipFile(self._file)
        except _FAULTS as error:
            raise DataError(f"{source.name}: not a zip archive, or not all of one ({_said(error)})") from error
        for info in self._zip.infolist():
            # It would not be followed; but an archive that has one was made to harm.
            if leads_out(info.orig_filename):
                raise DataError(
                    f"{source.name}: holds {info.orig_filename!r}, which leads out of the folder it is for: "
                    "not to be trusted; name another --source"
                )

    def find(self, member: str) -> zipfile.ZipInfo | None:
        """What the directory says of a member, None where there is none; DataError where it cannot be right."""
        info = self._members.get(member)
        if info is not None:
            fault = self._fault(info)
            if fault:
                raise DataError(f"{self.source.name}: {member} {fault}; name another --source")
        return info

    def load(self, start: int, stop: int, report: Report = silent) -> None:
        """Have a stretch of the archive in memory, for the members that lie in it."""
        self._file.load(start, stop, report)

    def read(self, info: zipfile.ZipInfo) -> bytes:
        """A member's content, its size and CRC-32 checked; DataError where they are not as the directory says."""
        try:
            with self._zip.open(info) as member:
                data = member.read(info.file_size + 1)
        except _FAULTS as error:
            raise self._damaged(info, _said(error)) from error
        if len(data) != info.file_size:
            raise self._damaged(info, f"{len(data)} bytes where {info.file_size} are due")
        return data

    @cached_property
    def _members(self) -> dict[str, zipfile.ZipInfo]:
        return {info.orig_filename: info for info in self._zip.infolist()}

    @cached_property
    def _copies(self) -> Counter[str]:
        return Counter(info.orig_filename for info in self._zip.infolist())

    def _fault(self, info: zipfile.ZipInfo) -> str:
        """Why a member cannot be what is wanted."""
        if self._copies[info.orig_filename] > 1:
            return "is in it twice"
        if stat.S_ISLNK(info.external_attr >> 16):
            return "is a link, not a file"
        if info.flag_bits & 1:
            return "is encrypted"
        if info.file_size > _LARGEST:
            return f"is said to have {info.file_size >> 20} MiB, too much for a file of its kind"
        if info.header_offset + info.compress_size > self.source.size:
            return "is said to lie beyond the archive's end"
        return ""

    def _damaged(self, info: zipfile.ZipInfo, why: str) -> DataError:
        return DataError(
            f"{self.source.name}: {info.orig_filename} is damaged ({why}); "
            "run the same command again, or name another --source"
        )


def _said(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__
