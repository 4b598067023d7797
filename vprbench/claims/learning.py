"""What can be measured of learning: reconstruction rates, learning times and signature sizes."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log
from typing import Literal

import numpy as np

from vprbench.agents import build_encoder
from vprbench.claims.fits import Fits, find_measure, find_seconds, mean_interval
from vprbench.claims.reading import Evidence, Measurement, Reading, Untestable
from vprbench.protocols import Stepwise
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH

__all__ = ["LearningRatio", "LearningTime", "RateDifference", "SignatureSize"]


class RateDifference(Measurement):
    """An encoder's reconstruction rate less another's, over the seeds of both, in points.

    Attributes:
        encoder: canonical name.
        reference: canonical name.
        rate: column of fit.csv.
    """

    kind: Literal["rate-difference"]
    encoder: str
    reference: str
    rate: str

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The difference and its interval over seeds."""
        one, other = (find_measure(evidence, name, self.rate) for name in (self.encoder, self.reference))
        pairs = _pairs(one, other)
        value, low, high = mean_interval([100 * (a - b) for a, b in pairs])
        means = np.mean(pairs, axis=0)
        remark = f"rates {means[0]:.3f} and {means[1]:.3f}"
        return Reading(value, low, high, *_where(one, routes, len(pairs)), remark)


class LearningTime(Measurement):
    """How long an encoder learns, seconds.

    Attributes:
        encoder: canonical name.
    """

    kind: Literal["learning-time"]
    encoder: str

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The mean time and its interval over seeds."""
        fits = find_seconds(evidence, self.encoder)
        return Reading(*mean_interval(list(fits.by_seed.values())), *_where(fits, routes, len(fits.by_seed)))


class LearningRatio(Measurement):
    """How long an encoder learns, in parts of how long another does; the geometric mean over the seeds of both.

    Attributes:
        encoder: canonical name.
        reference: canonical name.
    """

    kind: Literal["learning-ratio"]
    encoder: str
    reference: str

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The ratio and its interval over seeds."""
        one, other = (find_seconds(evidence, name) for name in (self.encoder, self.reference))
        if one.machine != other.machine:
            raise Untestable(f"{self.encoder} and {self.reference} were timed on two machines")
        pairs = _pairs(one, other)
        value, low, high = (exp(bound) for bound in mean_interval([log(a / b) for a, b in pairs]))
        means = np.mean(pairs, axis=0)
        return Reading(value, low, high, *_where(one, routes, len(pairs)), f"{means[0]:.1f} s and {means[1]:.1f} s")


class SignatureSize(Measurement):
    """How many numbers describe one landmark.

    Attributes:
        encoder: canonical name.
    """

    kind: Literal["signature-size"]
    encoder: str

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The size, from fit.csv, or from an encoded frame where there is nothing to learn."""
        fixed = _fixed_size(self.encoder)
        if fixed is not None:
            return Reading(fixed, fixed, fixed, "an encoded frame")
        fits = find_measure(evidence, self.encoder, "signature_size")
        sizes = list(fits.by_seed.values())
        return Reading(sizes[0], min(sizes), max(sizes), f"fit.csv, {len(sizes)} seeds")


def _fixed_size(encoder: str) -> float | None:
    """The size of an encoder's signatures; None where that is known only once it has learned."""
    made = build_encoder(encoder)
    if isinstance(made, Stepwise):
        return None
    noise = np.random.default_rng(0).integers(0, 256, (FRAME_HEIGHT, FRAME_WIDTH), np.uint8)
    return float(made.encode(noise).signatures.shape[1])


def _pairs(one: Fits, other: Fits) -> list[tuple[float, float]]:
    if not (pairs := one.paired(other)):
        raise Untestable("the two encoders were fitted with no seed in common")
    return pairs


def _where(fits: Fits, routes: Sequence[str], seeds: int) -> tuple[str, bool]:
    """What was measured on, in words, and whether it is what the claim speaks of."""
    at_home = fits.route in routes
    label = "" if at_home else "stand-in: "
    machine = f"; {fits.machine}" if fits.machine else ""
    return f"{label}training frames of {fits.route}; {seeds} seed{'s' * (seeds != 1)}{machine}", at_home
