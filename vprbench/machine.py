"""The machine that a timing was taken on."""

from __future__ import annotations

import os
import platform
from pathlib import Path

from vprbench.provenance import versions

__all__ = ["cores", "machine"]


def cores() -> int:
    """Processors this process may use; not every system tells more than how many there are."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def machine() -> dict[str, str | int]:
    """What decides how long a computation takes: processor, cores, system and versions."""
    return {"processor": _processor(), "cores": cores(), "system": platform.system(), **versions()}


def _processor() -> str:
    """The processor's model as its system names it."""
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    models = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(models, platform.machine())
