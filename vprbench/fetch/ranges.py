"""In how few requests members of an archive can be had: neighbours are read together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from zipfile import ZipInfo

__all__ = ["Stretch", "stretches"]

# Bytes, our choice. At 50 ms a round trip and 5 MB/s, a request takes as long as 256 KiB do; and what has come of a
# stretch is lost when the program is stopped in the middle of it.
_GAP, _LONGEST = 1 << 18, 1 << 23

# Bytes. A member's own header has 30, its name, and extra fields, which may be longer than those in the directory.
_HEADER, _SPARE = 30, 256


@dataclass(frozen=True)
class Stretch:
    """Members that lie near each other in an archive.

    Attributes:
        start: the first byte.
        stop: the byte after the last.
        members: those whose headers and content lie between.
    """

    start: int
    stop: int
    members: tuple[ZipInfo, ...]


def stretches(members: Iterable[ZipInfo], size: int, gap: int = _GAP, longest: int = _LONGEST) -> list[Stretch]:
    """Stretches of an archive that together hold some of its members, in the order of the archive.

    Args:
        members: those wanted.
        size: of the archive, bytes.
        gap: as many bytes between two members, at most, are read rather than asked around.
        longest: no stretch of several members is longer.
    """
    found: list[Stretch] = []
    for member in sorted(members, key=lambda info: info.header_offset):
        start, stop = member.header_offset, min(_end(member), size)
        last = found[-1] if found else None
        if last is not None and start - last.stop <= gap and stop - last.start <= longest:
            found[-1] = Stretch(last.start, max(stop, last.stop), (*last.members, member))
        else:
            found.append(Stretch(start, stop, (member,)))
    return found


def _end(member: ZipInfo) -> int:
    """Behind the last byte that reading a member may ask for."""
    name = len(member.orig_filename.encode())
    return member.header_offset + _HEADER + name + len(member.extra) + _SPARE + member.compress_size
