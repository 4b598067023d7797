"""Where a result comes from: versions, commit and data, for every row."""

from __future__ import annotations

import hashlib
import platform
import subprocess
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from vprbench.plugins import Kind, plugins
from vprbench.route import Route

__all__ = ["data_checksum", "origins", "versions"]

REPOSITORY = Path(__file__).resolve().parents[1]
LIBRARIES = ("numpy", "opencv-python-headless", "numba")


def data_checksum(route: Route) -> str:
    """Short sha256 over the checksums of all drives of a route."""
    drives = (route.learn, route.test, *route.training)
    return hashlib.sha256("".join(drive.checksum for drive in drives).encode()).hexdigest()[:16]


def origins(config: Mapping[str, Any]) -> str:
    """The distributions, with versions, that an agent's plug-ins come from; `config` as `normalise` gives it."""
    named: list[tuple[Kind, str]] = [("localizer", config["localizer"])]
    if "encoder" in config:
        named.append(("encoder", config["encoder"]["name"]))
    known = [plugins(kind)[name].origin for kind, name in named if name in plugins(kind)]
    return ", ".join(dict.fromkeys(known))


@cache
def versions() -> dict[str, str]:
    """Versions of all that decides a score, and the commit of a source checkout."""
    return {
        "vprbench": version("vprbench"),
        "commit": _commit(),
        "python": platform.python_version(),
        "libraries": " ".join(f"{name}={version(name)}" for name in LIBRARIES),
    }


def _commit() -> str:
    """The commit of this checkout, with "+" where its code has changed since; empty for an installed package."""
    if not (REPOSITORY / ".git").exists():
        return ""
    code = ["pyproject.toml", "vprbench", "encoders", "localizers"]
    changed = _git("status", "--porcelain", "--untracked-files=no", "--", *code)
    return _git("rev-parse", "--short=12", "HEAD") + ("+" if changed else "")


def _git(*words: str) -> str:
    """What git says; empty where there is no git, since a result must not depend on having it."""
    try:
        done = subprocess.run(["git", "-C", str(REPOSITORY), *words], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout.strip()
