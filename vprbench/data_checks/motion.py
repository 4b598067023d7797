"""Is a drive one that a vehicle makes: do its times run on, and its positions without a jump?"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import Int64

from vprbench.data_checks.finding import Finding
from vprbench.frame_ranges import format_ranges
from vprbench.route import Traverse

__all__ = ["frames_of", "motion_findings"]

# A step is a jump, or an interval a gap, that is so many times what three quarters of the drive's are. Our choice: the
# steps of KITTI's eleven sequences reach 1.6 times.
_FAR = 3.0

# Metres and seconds below which neither is worth a word. Our choice.
_SHORT, _BRIEF = 1.0, 0.5


def motion_findings(drive: Traverse) -> Iterator[Finding]:
    """Times that do not increase, jumps and gaps, each with the frames after which it comes."""
    intervals, steps = np.diff(drive.times), np.diff(drive.distance)
    back = np.flatnonzero(intervals <= 0)
    if back.size:
        what = f"{back.size} times are not after the one before"
        yield Finding("error", "times", frames_of(drive, back + 1), what, "give the time of each frame, in seconds")
        return
    speeds = steps / intervals
    far = np.flatnonzero((speeds > _FAR * _usual(speeds)) & (steps > _SHORT))
    if far.size:
        what = f"{_steps(far)} far beyond the drive's usual speed, the longest {steps[far].max():.1f} m"
        yield Finding("warning", "jumps", frames_of(drive, far + 1), what, "check the positions there")
    long = np.flatnonzero((intervals > _FAR * _usual(intervals)) & (intervals > _BRIEF))
    if long.size:
        what = f"{_steps(long)} after a pause, the longest of {intervals[long].max():.1f} s"
        yield Finding("warning", "gaps", frames_of(drive, long + 1), what, "see whether frames are missing before it")


def frames_of(drive: Traverse, rows: Int64[np.ndarray, " rows"]) -> str:
    """A drive and some of its frames, by their numbers in the data set."""
    return f"{drive.name}, frame{'s' if len(rows) > 1 else ''} {format_ranges(drive.indices[rows].tolist())}"


def _usual(values: np.ndarray) -> float:
    """What three quarters of the values lie below."""
    return float(np.quantile(values, 0.75)) if len(values) else 0.0


def _steps(rows: np.ndarray) -> str:
    return "a step" if len(rows) == 1 else f"{len(rows)} steps"
