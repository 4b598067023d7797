"""What a route needs on disk, and what of it is there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from vprbench.errors import DataError
from vprbench.frame_ranges import format_ranges

__all__ = ["Availability", "Need", "need_of"]

# How many ranges of frames a message names.
_RANGES = 12


@dataclass(frozen=True)
class Need:
    """The files of one recording that a route needs, and those that are not there.

    Attributes:
        source: the recording in words, for example "KITTI odometry sequence 00".
        folder: where its frames are looked for.
        frames: the frame numbers needed.
        missing: those of them that lack a file.
        absent: other files that are not there (poses, times, calibration).
        remedy: how to get them.
        files: all that are needed, of frames and others.
        public: whether `vprbench fetch` can get them.
    """

    source: str
    folder: Path
    frames: tuple[int, ...]
    missing: tuple[int, ...]
    absent: tuple[Path, ...]
    remedy: str
    files: tuple[Path, ...] = ()
    public: bool = False

    @property
    def complete(self) -> bool:
        """Whether everything is there."""
        return not self.missing and not self.absent

    def __str__(self) -> str:
        """What is needed, what is there and what is not, in one line."""
        if not self.frames:
            return f"{self.source}, a file that is not there"
        there = len(self.frames) - len(self.missing)
        text = f"frames {_short(self.frames)} of {self.source}: "
        text += f"{there} of {len(self.frames)} are in {self.folder}"
        if self.missing:
            text += f", missing {_short(self.missing)}"
        if self.absent:
            text += f"; no file {', '.join(map(str, self.absent))}"
        return text


@dataclass(frozen=True)
class Availability:
    """Whether a route can be loaded, and what stands in its way.

    Attributes:
        route: the route's name.
        needs: what it needs of each recording; empty for a route that is drawn.
    """

    route: str
    needs: tuple[Need, ...]

    @property
    def present(self) -> int:
        """Number of needed frames that are there."""
        return sum(len(need.frames) for need in self.needs) - self.missing

    @property
    def missing(self) -> int:
        """Number of needed frames that are not there."""
        return sum(len(need.missing) for need in self.needs)

    @property
    def complete(self) -> bool:
        """Whether the route can be loaded."""
        return all(need.complete for need in self.needs)

    @property
    def wanting(self) -> tuple[Need, ...]:
        """The needs that are not met."""
        return tuple(need for need in self.needs if not need.complete)

    @property
    def hint(self) -> str:
        """The command that gets what is missing, as a sentence; empty where none does."""
        public = any(need.public for need in self.wanting)
        return f"`vprbench fetch {self.route}` gets what is missing." if public else ""

    def require(self) -> None:
        """Raise DataError, with the remedy, unless everything is there."""
        if self.wanting:
            remedies = dict.fromkeys(need.remedy for need in self.wanting)
            said = [f"{self.route} needs {'; and '.join(map(str, self.wanting))}.", self.hint, *remedies]
            raise DataError(" ".join([*filter(None, said), "`vprbench list` shows what is there."]))


def need_of(
    source: str,
    folder: Path,
    frames: Mapping[int, tuple[Path, ...]],
    others: Iterable[Path],
    remedy: str,
    *,
    public: bool = False,
) -> Need:
    """A recording's need, checked against its folders' listings (no file is opened).

    Args:
        source: the recording in words.
        folder: where its frames are looked for, for the message.
        frames: the files of each frame number needed.
        others: the other files needed.
        remedy: how to get them, a sentence.
        public: whether `vprbench fetch` can get them.
    """
    others = tuple(others)
    listings = {parent: _names(parent) for parent in {path.parent for paths in frames.values() for path in paths}}
    missing = tuple(sorted(i for i, paths in frames.items() if any(p.name not in listings[p.parent] for p in paths)))
    absent = tuple(path for path in others if not path.is_file())
    files = tuple(path for i in sorted(frames) for path in frames[i]) + others
    return Need(source, folder, tuple(sorted(frames)), missing, absent, remedy, files, public)


def _short(frames: Sequence[int]) -> str:
    """The frames as ranges, the first so many of them where a thinned drive has hundreds."""
    ranges = format_ranges(frames).split(", ")
    return ", ".join(ranges[:_RANGES]) + (f", ... {frames[-1]}" if len(ranges) > _RANGES else "")


def _names(folder: Path) -> frozenset[str]:
    try:
        return frozenset(path.name for path in folder.iterdir())
    except OSError:
        return frozenset()
