"""Can every frame of a drive be read, and is it another picture than those elsewhere on the road?

Pictures are compared by a difference hash of 64 bits: whether each of 8 x 9 areas is brighter than the one on its left
(N. Krawetz, "Kind of like that", 2013).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from itertools import combinations

import cv2
import numpy as np
from jaxtyping import Bool, Float64, Int64

from vprbench.data_checks.finding import Finding
from vprbench.data_checks.motion import frames_of
from vprbench.errors import DataError
from vprbench.reporting import Report, silent
from vprbench.route import Traverse
from vprbench.types import Frame

__all__ = ["Pictures", "difference_hash", "duplicate_findings", "look", "shared_findings"]

# Frames that differ by no more bits are one picture, unless they lie no more metres apart: a standing vehicle sees what
# it saw. Our choice: of 521 frames of KITTI 00 no two that lie 3 m apart differ by less than 6 bits.
_SAME_BITS, _APART = 2, 3.0


@dataclass(frozen=True)
class Pictures:
    """The frames of a drive that can be read.

    Attributes:
        drive: which.
        rows: (n,) the frames' places in it.
        hashes: (n, 64) the difference hash of each.
        digests: the sha256 of each, as reduced.
        faults: why each other frame cannot be read.
    """

    drive: Traverse
    rows: Int64[np.ndarray, " n"]
    hashes: Bool[np.ndarray, "n 64"]
    digests: tuple[bytes, ...]
    faults: tuple[str, ...]

    @property
    def positions(self) -> Float64[np.ndarray, "n 2"]:
        """Where they were taken, metres."""
        return self.drive.positions[self.rows]

    def findings(self) -> Iterator[Finding]:
        """The frames that cannot be read."""
        for fault in self.faults:
            what, _, remedy = fault.rpartition("; ")
            yield Finding("error", "frames", self.drive.name, what or fault, remedy if what else "mend or replace it")


def difference_hash(frame: Frame) -> Bool[np.ndarray, "64"]:
    """Whether each of 8 x 8 areas of a frame is darker than the one on its right."""
    small = cv2.resize(frame, (9, 8), interpolation=cv2.INTER_AREA).astype(np.int64)
    return (small[:, :-1] < small[:, 1:]).ravel()


def look(drive: Traverse, report: Report = silent) -> Pictures:
    """Read every frame of a drive."""
    rows, hashes, digests, faults = list[int](), list[np.ndarray](), list[bytes](), list[str]()
    for row in range(len(drive)):
        report(drive.name, row, len(drive))
        try:
            frame = drive.frames[row]
        except DataError as error:
            faults.append(str(error))
            continue
        rows.append(row)
        hashes.append(difference_hash(frame))
        digests.append(sha256(frame.tobytes()).digest())
    found = np.array(hashes, bool).reshape(len(rows), 64)
    return Pictures(drive, np.array(rows, np.int64), found, tuple(digests), tuple(faults))


def shared_findings(seen: Sequence[Pictures]) -> Iterator[Finding]:
    """Frames that two drives have in common to the last bit: what was learned would be recognised for nothing."""
    for one, other in combinations(seen, 2):
        common = set(one.digests) & set(other.digests)
        if common:
            mine, theirs = (p.rows[[digest in common for digest in p.digests]] for p in (one, other))
            what = f"the very picture of {frames_of(other.drive, theirs)}"
            yield Finding("error", "shared-frames", frames_of(one.drive, mine), what, "leave it out of one drive")


def duplicate_findings(seen: Sequence[Pictures]) -> Iterator[Finding]:
    """Frames that show one picture though they lie apart: copied, or filmed by a camera that hung.

    Args:
        seen: drives in one plane.
    """
    for number, one in enumerate(seen):
        for other in seen[number:]:
            alike = _alike(one, other)
            if alike.any():
                copies, originals = one.rows[alike.any(axis=1)], other.rows[alike.any(axis=0)]
                what = f"the same picture as {frames_of(other.drive, originals)}, {_APART:g} m and more away"
                remedy = "see whether files were copied or the camera hung"
                yield Finding("warning", "duplicate-frames", frames_of(one.drive, copies), what, remedy)


def _alike(one: Pictures, other: Pictures) -> Bool[np.ndarray, "n m"]:
    """Which pairs of frames show one picture though they lie apart; of a drive with itself each pair once."""
    mine, theirs = (np.where(pictures.hashes, 1, -1).astype(np.float32) for pictures in (one, other))
    differ = (mine.shape[1] - mine @ theirs.T) / 2
    gaps = np.linalg.norm(one.positions[:, None] - other.positions[None], axis=2)
    alike = (differ <= _SAME_BITS) & (gaps >= _APART)
    return np.triu(alike) if one is other else alike
