"""When a dictionary has converged, and how its rate of learning falls."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

__all__ = ["Fall", "Passes"]


class Fall(NamedTuple):
    """A share that falls linearly from `level` at step `begin` to 0 at step `end`."""

    begin: int
    end: int
    level: float = 1.0

    def share(self, step: int) -> float:
        """The share at a step before the end."""
        return self.level * (1 - (step - self.begin) / (self.end - self.begin))

    def shortened(self, step: int, steps: int) -> Fall:
        """The fall that goes on from a step of this one, and ends after so many more at the latest."""
        end = min(self.end, step + steps)
        return Fall(step, end, self.share(step) if step < end else 0.0)


@dataclass
class Passes:
    """Passes over the same batches, told apart by how well they were coded.

    Attributes:
        length: batches a pass.
        tolerance: a pass that is not better by so much than the one before has converged; 0: none has.
    """

    length: int
    tolerance: float
    _sum: float = field(default=0.0, init=False)
    _seen: int = field(default=0, init=False)
    _before: float = field(default=float("-inf"), init=False)

    def converged(self, rate: float) -> bool:
        """Whether the pass that this batch completes has converged; False within a pass."""
        self._sum += rate
        self._seen += 1
        if self.tolerance == 0 or self._seen < self.length:
            return False
        mean, before = self._sum / self._seen, self._before
        self._sum, self._seen, self._before = 0.0, 0, mean
        return mean - before < self.tolerance
