"""From a frame to its local views: the whitened disks around its focus points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float32

from vprbench.errors import ConfigError, DataError
from vprbench.types import Frame
from vprbench_encoders.focus import FocusDetector
from vprbench_encoders.patches import LocalView, jittered
from vprbench_encoders.resolution import reduced
from vprbench_encoders.stepwise import Progress, Work
from vprbench_encoders.whitening import whiten

__all__ = ["LocalViews", "TrainingViews", "ViewSampling"]


@dataclass(frozen=True)
class LocalViews:
    """What is seen of a frame.

    Attributes:
        focus: where to look.
        view: what to take in there.
        cutoff: of the whitening filter, cycles/px of the halved frame; None: no whitening.
        focus_reduction: focus points are sought at 1/focus_reduction of the frame's resolution.
    """

    focus: FocusDetector
    view: LocalView
    cutoff: float | None
    focus_reduction: int = 1

    def points(self, frame: Frame) -> Float32[np.ndarray, "points 2"]:
        """The focus points (u, v) of a frame."""
        return self.focus.points_of(frame, self.focus_reduction)

    def cut(self, frame: Frame, points: Float32[np.ndarray, "points 2"]) -> Float32[np.ndarray, "points size"]:
        """The view around each point; the frame is whitened whole, so that no view has a border of its own."""
        image = reduced(frame.astype(np.float32), 2)
        return self.view.cut(image if self.cutoff is None else whiten(image, self.cutoff), points)


class TrainingViews(NamedTuple):
    """Local views to learn from, and views of later frames that only measure what was learned."""

    training: Float32[np.ndarray, "n size"]
    held_out: Float32[np.ndarray, "others size"]


@dataclass(frozen=True, kw_only=True)
class ViewSampling:
    """Which views are learned from; all of it is our choice.

    Attributes:
        frames: at most so many, evenly spaced.
        held_out: share of those, the last, that only measure.
        jitter: views learned from are moved by up to so many px of the frame ...
        copies: ... so that each point gives so many, the first unmoved.
    """

    frames: int
    held_out: float
    jitter: int
    copies: int

    def __post_init__(self) -> None:
        """Refuse values that leave nothing to learn from."""
        if self.frames < 1 or self.copies < 1 or self.jitter < 0:
            raise ConfigError(
                "training_frames and copies must be at least 1 and jitter at least 0, "
                f"not {self.frames}, {self.copies} and {self.jitter}"
            )
        if not 0 <= self.held_out < 1:
            raise ConfigError(f"held_out must be at least 0 and below 1, not {self.held_out}")

    def drawing(self, views: LocalViews, frames: Sequence[Frame], random: np.random.Generator) -> Work[TrainingViews]:
        """The views of these frames, each of which is read once, frame by frame.

        Raises:
            DataError: there is no focus point in any of them.
        """
        kept = np.linspace(0, len(frames) - 1, min(self.frames, len(frames))).round().astype(int)
        learned = len(kept) - int(self.held_out * len(kept))
        training, held_out = [], [np.empty((0, views.view.size), np.float32)]
        for place, index in enumerate(kept.tolist()):
            frame = frames[index]
            points = views.points(frame)
            if place < learned:
                training.append(views.cut(frame, jittered(points, self.jitter, self.copies, random)))
            else:
                held_out.append(views.cut(frame, points))
            yield Progress(place + 1, len(kept))
        if not sum(map(len, training)):
            raise DataError(f"none of {len(frames)} training frames has a focus point; give frames with texture")
        return TrainingViews(np.concatenate(training), np.concatenate(held_out))
