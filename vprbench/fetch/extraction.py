"""Members of archives written as files, each whole or not at all; room and rights are checked first."""

from __future__ import annotations

import errno
import shutil
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

from vprbench.atomic import clear_leftovers, replacing
from vprbench.errors import DataError
from vprbench.fetch.plan import ArchivePlan
from vprbench.fetch.ranges import Stretch, stretches
from vprbench.reporting import Report, part_of, silent

__all__ = ["check_disk", "extract", "transfer"]


def transfer(plans: Iterable[ArchivePlan]) -> int:
    """Bytes to be read of archives, of which those between two members are some."""
    return sum(stretch.stop - stretch.start for plan in plans for stretch in _stretches(plan))


def check_disk(plans: Sequence[ArchivePlan], root: Path) -> None:
    """Raise DataError unless everything to be written can be: before anything is fetched."""
    needed = sum(plan.bytes for plan in plans)
    paths = [item.path for plan in plans for item in plan.todo]
    try:
        for folder in sorted({path.parent for path in paths}):
            folder.mkdir(parents=True, exist_ok=True)
            # A folder may be there and yet refuse files.
            with tempfile.TemporaryFile(dir=folder):
                pass
            clear_leftovers(folder, {path.name for path in paths})
        free = shutil.disk_usage(root).free if needed else 0
    except OSError as error:
        raise _unwritable(Path(error.filename or root), error) from error
    if needed > free:
        raise DataError(
            f"{root}: {_megabytes(needed)} are needed and {_megabytes(free)} are free; "
            "make room, or name another folder with --data"
        )


def extract(plan: ArchivePlan, report: Report = silent) -> None:
    """Write all that is to be had from one archive.

    Args:
        plan: what that is.
        report: told the bytes of the archive that were read.

    Raises:
        DataError: the archive cannot be read or is damaged, or the disk is full; what was written stays.
    """
    paths = {item.info.orig_filename: item.path for item in plan.todo}
    total, before = transfer([plan]), 0
    for stretch in _stretches(plan):
        plan.contents.load(stretch.start, stretch.stop, part_of(report, before, total))
        for member in stretch.members:
            _write(paths[member.orig_filename], plan.contents.read(member))
        before += stretch.stop - stretch.start


def _write(path: Path, content: bytes) -> None:
    try:
        with replacing(path) as temporary:
            temporary.write_bytes(content)
    except OSError as error:
        raise _unwritable(path, error) from error


def _unwritable(path: Path, error: OSError) -> DataError:
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return DataError(f"{path}: the disk is full; make room and run the same command again: it goes on from there")
    return DataError(f"{path}: cannot be written ({error.strerror}); name another folder with --data")


def _stretches(plan: ArchivePlan) -> list[Stretch]:
    return stretches((item.info for item in plan.todo), plan.contents.source.size)


def _megabytes(count: int) -> str:
    return f"{count / 1e6:.1f} MB"
