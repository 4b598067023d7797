"""`vprbench data revisits`: routes where a recording drives a road twice."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.console import Console

from vprbench.errors import ConfigError, nearest
from vprbench.proposals import propose, to_toml
from vprbench.recordings import open_recording
from vprbench.revisits import Direction

__all__ = ["revisits_command"]

_DIRECTIONS: Mapping[str, Sequence[Direction]] = {
    "same": ("same",),
    "reverse": ("reverse",),
    "both": ("same", "reverse"),
}


def revisits_command(text: str, data: Path | None, direction: str, length: float, field_of_view: float) -> None:
    """Print a catalogue file with a route for every road driven twice."""
    if direction not in _DIRECTIONS:
        raise ConfigError(f"--direction {direction!r}: {nearest(direction, _DIRECTIONS)}")
    recording = open_recording(text, data, field_of_view)
    with Console(stderr=True).status("compare positions"):
        proposals = propose(recording, _DIRECTIONS[direction], length)
    Console().out(to_toml(recording, proposals), highlight=False, end="")
