"""The frames of a drive along a drawn street."""

from __future__ import annotations

from dataclasses import dataclass

from vprbench.street.drive import Drive
from vprbench.street.parameters import StreetParameters
from vprbench.types import Frame

__all__ = ["StreetFrames"]


@dataclass(frozen=True)
class StreetFrames:
    """Frame t of one drive, drawn when it is asked for; a FrameSource.

    The same t always gives the same bytes, whatever was asked for before and in whatever process.
    """

    parameters: StreetParameters
    drive: Drive

    def __getitem__(self, index: int, /) -> Frame:
        """Frame `index`, drawn anew."""
        # Whoever only lists or loads routes should not wait for the compiled painter.
        from vprbench.street.drawing import draw_frame

        return draw_frame(self.parameters, self.drive, index)
