"""A compass that errs: the headings of a drive, each off by a random angle."""

from __future__ import annotations

from dataclasses import replace
from hashlib import sha256

import numpy as np

from vprbench.errors import DataError
from vprbench.route import Traverse

__all__ = ["noisy_compass"]


def noisy_compass(traverse: Traverse, sd_deg: float, seed: int) -> Traverse:
    """The same drive with normal noise on its headings, independent from frame to frame.

    Args:
        traverse: the drive; its frames and positions stay.
        sd_deg: standard deviation of the noise, degrees.
        seed: says which noise; of one seed, twice the standard deviation is twice each error.

    Raises:
        DataError: the drive has no headings.
    """
    if traverse.heading_source == "absent":
        raise DataError(f"{traverse.name}: no headings that could be noisy; leave heading_noise_deg out")
    errors = np.random.default_rng(seed).normal(0.0, np.radians(sd_deg), len(traverse))
    return replace(
        traverse,
        name=f"{traverse.name}, compass noisy by {sd_deg:g} degrees",
        headings=(traverse.headings + errors + np.pi) % (2 * np.pi) - np.pi,
        checksum=sha256(f"{traverse.checksum}, heading noise {sd_deg!r}, seed {seed}".encode()).hexdigest(),
    )
