"""The errors that a user can cause: each says what was wrong, where, and what to do."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

__all__ = ["ConfigError", "DataError", "PhaseError", "PluginError", "VprbenchError", "nearest"]


class VprbenchError(Exception):
    """Any fault that the user can mend; the command line shows its text without a traceback."""

    exit_code = 1


class ConfigError(VprbenchError):
    """A key, name or value in a configuration that is not among the allowed ones."""

    exit_code = 2


class DataError(VprbenchError):
    """A frame, pose, calibration or time that is missing, damaged or contradicts another."""

    exit_code = 3


class PluginError(VprbenchError):
    """A plug-in that does not import, or does not keep its protocol."""

    exit_code = 4


class PhaseError(VprbenchError):
    """An episode phase that was entered before the one it builds on."""


def nearest(name: str, allowed: Iterable[str]) -> str:
    """Say which allowed name is meant, or which there are: the tail of an 'unknown name' message."""
    names = sorted(allowed)
    close = get_close_matches(name, names, n=1, cutoff=0.5)
    listed = "allowed: " + (", ".join(names) or "none")
    return f"did you mean {close[0]!r}? ({listed})" if close else f"({listed})"
