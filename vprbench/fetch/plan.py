"""Which members of which archives become which files, and which of these are on disk already."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from zipfile import ZipInfo

from vprbench.errors import DataError
from vprbench.fetch.archives import Location, locations
from vprbench.fetch.contents import Contents

__all__ = ["ArchivePlan", "Item", "locate", "plan"]

Sought = Mapping[Path, tuple[Location, ...]]


@dataclass(frozen=True)
class Item:
    """A file and the member of an archive that it is a copy of."""

    path: Path
    info: ZipInfo


@dataclass(frozen=True)
class ArchivePlan:
    """What is to be done with one archive.

    Attributes:
        contents: the archive.
        there: files on disk whose size and CRC-32 are the archive's.
        absent: files that are not on disk.
        differing: files on disk that are not as in the archive.
    """

    contents: Contents
    there: tuple[Item, ...]
    absent: tuple[Item, ...]
    differing: tuple[Item, ...]

    @property
    def todo(self) -> tuple[Item, ...]:
        """The files to be written."""
        return (*self.absent, *self.differing)

    @property
    def bytes(self) -> int:
        """Their size on disk."""
        return sum(item.info.file_size for item in self.todo)


def locate(files: Iterable[Path], root: Path) -> dict[Path, tuple[Location, ...]]:
    """Where each file is published; DataError where one is part of no data set that can be fetched.

    Args:
        files: that a route needs.
        root: the data root.
    """
    sought = {path: _locations(path, root) for path in files}
    strangers = [path for path, places in sought.items() if not places]
    if strangers:
        raise DataError(f"{strangers[0]}: part of no data set that vprbench can fetch; put it there yourself")
    return sought


def plan(sought: Sought, contents: Callable[[Location], Contents]) -> list[ArchivePlan]:
    """What is to be had from each archive, compared with what is on disk.

    Args:
        sought: where each file is published; the first archive that holds it is taken.
        contents: opens an archive, the same one at every call with the same.

    Raises:
        DataError: an archive cannot be read, or lacks a member, which is named.
    """
    items: dict[Contents, list[Item]] = {}
    missing: dict[str, list[str]] = {}
    for path, places in sought.items():
        for place in places:
            archive = contents(place)
            info = archive.find(place.member)
            if info is not None:
                items.setdefault(archive, []).append(Item(path, info))
                break
        else:
            missing.setdefault(archive.source.name, []).append(place.member)
    if missing:
        name, members = next(iter(missing.items()))
        more = f" and {len(members) - 1} more" if len(members) > 1 else ""
        raise DataError(f"{name}: has no {members[0]}{more}; check the route's frames, or name another --source")
    return [_compared(archive, group) for archive, group in items.items()]


def _locations(path: Path, root: Path) -> tuple[Location, ...]:
    return locations(PurePosixPath(path.relative_to(root).as_posix())) if path.is_relative_to(root) else ()


def _compared(archive: Contents, items: Sequence[Item]) -> ArchivePlan:
    """Sort files by whether they are on disk, and as they should be."""
    there, absent, differing = list[Item](), list[Item](), list[Item]()
    for item in items:
        same = _same(item)
        (absent if same is None else there if same else differing).append(item)
    return ArchivePlan(archive, tuple(there), tuple(absent), tuple(differing))


def _same(item: Item) -> bool | None:
    """Whether a file has the member's size and CRC-32; None where there is no file."""
    try:
        if item.path.stat().st_size != item.info.file_size:
            return False
        return zlib.crc32(item.path.read_bytes()) == item.info.CRC
    except FileNotFoundError:
        return None
    except OSError as error:
        raise DataError(f"{item.path}: cannot be read ({error.strerror})") from error
