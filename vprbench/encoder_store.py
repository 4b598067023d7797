"""Fitted encoders on disk: one file a fit, written whole, made by one process while the others wait for it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from filelock import FileLock, Timeout

from vprbench.cache_root import cache_root
from vprbench.protocols import Storable
from vprbench.reporting import Report

__all__ = ["EncoderStore"]


@dataclass(frozen=True)
class EncoderStore:
    """A folder of fitted encoders.

    Attributes:
        folder: made when it is first needed.
    """

    folder: Path

    @classmethod
    def under(cls, given: Path | None) -> EncoderStore | None:
        """The store in a cache folder (default: see `cache_root`); None where nothing is to be kept."""
        root = cache_root(given)
        return None if root is None else cls(root / "encoders")

    def path(self, key: str) -> Path:
        """Where the encoder of a key lies."""
        return self.folder / f"{key}.npz"

    @contextmanager
    def alone(self, key: str, report: Report) -> Iterator[str]:
        """While entered, no other process fits this key; yields why nothing can be kept here, "" where it can.

        The system gives the lock of a process that died to the next.
        """
        fault, lock = "", FileLock(self.folder / f".{key}.lock")
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            _acquire(lock, report)
        except (OSError, NotImplementedError) as error:
            fault = f"encoder not stored: {self.folder} cannot be written ({getattr(error, 'strerror', None) or error})"
        try:
            yield fault
        finally:
            lock.release()

    def restore(self, kind: type[Storable], key: str) -> Storable | None:
        """The stored encoder of a key, or None; a damaged file raises whatever it makes `load` raise."""
        path = self.path(key)
        return kind.load(path) if path.exists() else None

    def keep(self, encoder: Storable, key: str) -> None:
        """Store an encoder, whole or not at all."""
        path = self.path(key)
        with TemporaryDirectory(dir=self.folder, prefix=".") as folder:
            # Called as it will be, since some writers add an ending to a name that has not theirs.
            encoder.save(Path(folder, path.name))
            Path(folder, path.name).replace(path)


def _acquire(lock: FileLock, report: Report) -> None:
    """Get the lock, and say so where that takes waiting."""
    try:
        lock.acquire(timeout=0)
    except Timeout:
        report("fit", 0, 1, "another process learns the same: waiting for it")
        lock.acquire()
