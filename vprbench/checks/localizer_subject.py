"""What the checks of a localizer work on."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from functools import cached_property

from vprbench.checks.samples import drive, training_drives, training_frames
from vprbench.protocols import Encoder, Localizer
from vprbench.types import Observation

__all__ = ["LocalizerSubject", "encoder_of"]


class LocalizerSubject:
    """The localizer under test, fitted when first needed, and a drive to learn."""

    def __init__(self, factory: Callable[[], Localizer]) -> None:
        self.factory = factory

    @cached_property
    def fitted(self) -> Localizer:
        """One that is fitted, for all checks that do not mind what it has learned since."""
        return self.fit()

    @property
    def drive(self) -> list[Observation]:
        """Six views, copied: what a localizer writes into them, no other check sees."""
        return deepcopy(self._views[:-1])

    @property
    def bend(self) -> list[Observation]:
        """The same views on a road that turns at every frame."""
        return drive(6, bent=True)

    @property
    def unseen(self) -> Observation:
        """A view that the drive does not show."""
        return deepcopy(self._views[-1])

    @cached_property
    def _views(self) -> list[Observation]:
        return drive(7)

    def fit(self) -> Localizer:
        """A new localizer that has trained off the road, through an encoder that did so before."""
        localizer = self.factory()
        if (encoder := encoder_of(localizer)) is not None:
            encoder.fit(training_frames())
        localizer.fit(training_drives())
        return localizer

    def cleared(self, sampling: float | None = None) -> Localizer:
        """The localizer without places; by default at the vigilance or step that makes every frame a place."""
        dense = 1.0 if self.fitted.recruiting == "vigilance" else 0.5
        self.fitted.clear(dense if sampling is None else sampling)
        return self.fitted

    def learned(self) -> tuple[Localizer, list[Observation]]:
        """The localizer after the drive, and the observations that became places."""
        localizer = self.cleared()
        return localizer, [seen for seen in self.drive if localizer.learn(seen) is not None]


def encoder_of(localizer: Localizer) -> Encoder | None:
    """What a localizer looks through, if anything."""
    encoder = getattr(localizer, "encoder", None)
    return encoder if isinstance(encoder, Encoder) else None
