"""Where vprbench keeps on this machine what it need not compute twice."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs

__all__ = ["NOWHERE", "VARIABLE", "cache_root"]

VARIABLE = "VPRBENCH_CACHE"

# The name that stands for keeping nothing.
NOWHERE = "none"


def cache_root(given: Path | str | None = None) -> Path | None:
    """The folder given, else that of `VPRBENCH_CACHE`, else the user's cache folder; None where it is named "none"."""
    named = given or os.environ.get(VARIABLE)
    if not named:
        return platformdirs.user_cache_path("vprbench")
    return None if str(named) == NOWHERE else Path(named).expanduser().absolute()
