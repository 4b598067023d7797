"""A recording as a whole, by its name or path: where the vehicle was at each frame, and how its parts are written."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vprbench.data_root import data_root, expanded
from vprbench.entries.folder import folder_drive
from vprbench.errors import ConfigError
from vprbench.readers.kitti import OdometrySequence, read_motion
from vprbench.readers.kitti_raw import RawDrive
from vprbench.readers.motion import Motion

__all__ = ["Recording", "open_recording"]


@dataclass(frozen=True)
class Recording:
    """One recording.

    Attributes:
        name: what routes on it are called after.
        reader: of a catalogue entry for it.
        source: what stands before the colon of a run of its frames.
        first: number of its first frame.
        motion: where the vehicle was at each frame.
        options: what else an entry for it must say, as TOML.
    """

    name: str
    reader: str
    source: str
    first: int
    motion: Motion
    options: Mapping[str, str]

    def written(self, frames: range) -> str:
        """A run of frames, counted from the recording's first, as catalogue entries write it."""
        return f"{self.source}:{self.first + frames[0]}-{self.first + frames[-1]}"


def open_recording(text: str, data: Path | None = None, field_of_view: float = 82.0) -> Recording:
    """The recording that a text names: "00" (KITTI odometry), "2011_10_03_drive_0027" (KITTI raw), or a path.

    Args:
        text: the name; or the path of a drive of one's own, a CSV or the folder that holds its `frames.csv`.
        data: the data root, None for the default.
        field_of_view: of the camera of a drive of one's own, horizontal, degrees.

    Raises:
        ConfigError: the text is none of these.
        DataError: its files are missing or damaged.
    """
    if re.fullmatch(r"\d\d", text):
        sequence = OdometrySequence(data_root(data), text)
        times = sequence.folder / "times.txt"
        # Poses are what revisits are found from; times come with the images, which need not be here yet.
        motion = read_motion(sequence.poses, times if times.exists() else None)
        return Recording(text, "kitti-odometry", text, 0, motion, {})
    if re.fullmatch(r"\d{4}_\d\d_\d\d_drive_\d{4}", text):
        drive = RawDrive(data_root(data), text)
        whole = drive.whole()
        return Recording(text, "kitti-raw", text, whole.first, drive.motion(whole), {})
    return _own(expanded(Path(text)), field_of_view)


def _own(path: Path, field_of_view: float) -> Recording:
    """A drive of a user's own."""
    drive = folder_drive(path.absolute())
    if not drive.path.is_file():
        raise ConfigError(
            f"{path}: no recording; name a KITTI sequence (00), a raw drive (2011_10_03_drive_0027), or the CSV of a "
            "drive of your own or its folder"
        )
    fixes = drive.geodetic
    name = re.sub(r"[^\w-]+", "-", path.stem if path.stem != "frames" else drive.path.parent.name, flags=re.ASCII)
    options = {"camera": f"{{ field_of_view_deg = {field_of_view:g} }}"}
    motion = drive.motion(None if fixes is None else np.array(fixes[0]))
    return Recording(name.strip("-") or "drive", "folder", str(drive.path), 0, motion, options)
