"""Frames that the jobs of one worker share: the jobs of a route look at the same ones, and getting them costs much."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from vprbench.provenance import data_checksum
from vprbench.route import FrameSource, Route, Traverse
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Frame

__all__ = ["LIMIT", "FrameMemory"]

# Frames that fill 256 MB: more than any built-in route has. Our choice.
LIMIT = 2**28 // (FRAME_HEIGHT * FRAME_WIDTH)

# The frames kept of one route, by the checksum of their drive and their place in it.
_Kept = dict[tuple[str, int], Frame]


@dataclass(frozen=True)
class FrameMemory:
    """The frames of the routes played last.

    A route is known by the checksum of its data, so that one whose files have changed is read anew. Where there is no
    room, the routes played longest ago are forgotten; one that fills the memory alone keeps the frames it has, and its
    others are got each time they are asked for.

    Attributes:
        limit: frames to keep at most.
    """

    limit: int = LIMIT
    _routes: dict[str, _Kept] = field(default_factory=dict, init=False)

    def share(self, route: Route) -> Route:
        """The same route, each of its frames read or drawn once for as long as it is kept."""
        checksum = data_checksum(route)
        kept = self._routes[checksum] = self._routes.pop(checksum, {})

        def shared(drive: Traverse) -> Traverse:
            return replace(drive, frames=_SharedFrames(drive.frames, drive.checksum, kept, self))

        training = tuple(shared(drive) for drive in route.training)
        return replace(route, learn=shared(route.learn), test=shared(route.test), training=training)

    @property
    def kept(self) -> int:
        """How many frames there are."""
        return sum(map(len, self._routes.values()))

    def has_room(self) -> bool:
        """Whether the route played last may keep one more frame, others being forgotten for it if need be."""
        while self.kept >= self.limit:
            if len(self._routes) == 1:
                return False
            del self._routes[next(iter(self._routes))]
        return True


@dataclass(frozen=True)
class _SharedFrames:
    """The frames of one drive, looked up before they are got; a FrameSource."""

    source: FrameSource
    drive: str
    kept: _Kept
    memory: FrameMemory

    def __getitem__(self, index: int, /) -> Frame:
        """Frame `index`: a copy, so that nobody who writes into it spoils another's."""
        frame = self.kept.get((self.drive, index))
        if frame is None:
            frame = self.source[index]
            if self.memory.has_room():
                self.kept[self.drive, index] = frame
        return frame.copy()
