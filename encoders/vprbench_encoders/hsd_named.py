"""HSD's configurations by name: the paper's, and ours."""

from __future__ import annotations

from functools import partial

from vprbench_encoders.hsd import HSD

__all__ = ["hsd_12", "hsd_15", "hsd_15_30", "hsd_18", "hsd_21", "hsd_24", "hsd_30", "hsd_plus"]

hsd_12 = partial(HSD, size=12)
hsd_15 = partial(HSD, size=15)
hsd_18 = partial(HSD, size=18)
hsd_21 = partial(HSD, size=21)
hsd_24 = partial(HSD, size=24)
hsd_30 = partial(HSD, size=30)
hsd_15_30 = partial(HSD, size=15, map_size=30)

# Ours, chosen on drawn streets and warped frames (docs/hsd.md): the first layer's code alone, of more places.
hsd_plus = partial(
    HSD,
    topology=False,
    pool=1,
    signature="c1",
    picks=(15, 5),
    window=72,
    jitter=12,
    points=50,
    radius=14.0,
    focus_reduction=2,
)
