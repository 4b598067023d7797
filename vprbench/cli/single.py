"""`vprbench run`: one agent on one route, played frame by frame through the environment."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from gymnasium.wrappers import RecordVideo
from rich.console import Console

from vprbench.agents import build, label
from vprbench.bootstrap import intervals
from vprbench.catalogue import load_route
from vprbench.env import RouteEnv
from vprbench.episode import calibrate, judge, play
from vprbench.errors import ConfigError
from vprbench.metrics import evaluate
from vprbench.observation import Drive

__all__ = ["run_command"]


def run_command(
    route_name: str,
    agent: str,
    distance: float,
    seed: int,
    data: Path | None,
    routes: Path | None,
    trace_file: Path | None,
    video: Path | None,
) -> None:
    """Play one cell through the environment and print its scores; faults are not caught, as in a sweep."""
    console, config = Console(), _agent(agent)
    route, localizer = load_route(route_name, data, routes), build(config, seed)
    env = RouteEnv(route, distance, render_mode="rgb_array" if video else None)
    with Console(stderr=True).status("fit") as status:
        localizer.fit([Drive(drive) for drive in route.training])
        status.update("calibrate")
        sampling = calibrate(localizer, route, distance)
        status.update("learn, record and test")
        recording = play(_filmed(env, video), localizer)
    trace = judge(route, recording, distance)
    if trace_file is not None:
        trace.save(trace_file)
    scores, spread = evaluate(trace), intervals(trace)
    console.print(f"[bold]{label(config)}[/bold] on {route.name}, a place every {distance:g} m", highlight=False)
    console.print(f"{localizer.recruiting} {sampling:.6g}: {len(recording.place_frames)} places, {len(trace)} queries")
    for name, value in scores.items():
        low, high = spread.get(f"{name}_low"), spread.get(f"{name}_high")
        console.print(f"{name:32} {value:9.4f}" + (f"   95 % {low:.4f} .. {high:.4f}" if low is not None else ""))


def _agent(text: str) -> str | dict[str, Any]:
    """An agent's configuration from the command line: a bare name, or the inside of a TOML table."""
    if "=" not in text:
        return text
    try:
        table: dict[str, Any] = tomllib.loads(f"agent = {{{text}}}")["agent"]
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"agent {text!r}: not the inside of a TOML table: {error}") from error
    return table


def _filmed(env: RouteEnv, video: Path | None) -> Any:  # noqa: ANN401 - a wrapper or the environment itself
    """The environment, filmed in its third phase if a file is given."""
    if video is None:
        return env
    return RecordVideo(
        env, str(video.parent), lambda episode: episode == 2, name_prefix=video.stem, disable_logger=True
    )
