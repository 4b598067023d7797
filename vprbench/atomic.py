"""Files that are there whole or not at all."""

from __future__ import annotations

import os
import re
from collections.abc import Container, Iterator
from contextlib import contextmanager
from pathlib import Path

__all__ = ["clear_leftovers", "replacing"]


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A temporary path beside `path` that takes its place when the block ends without an error."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        yield temporary
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def clear_leftovers(folder: Path, names: Container[str]) -> None:
    """Remove what writers of files of these names left in a folder when they were killed."""
    for path in folder.iterdir():
        match = re.fullmatch(r"\.(.+)\.\d+\.tmp", path.name)
        if match is not None and match[1] in names:
            path.unlink(missing_ok=True)
