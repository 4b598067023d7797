"""`vprbench run`: one agent on one route, played frame by frame through the environment."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import gymnasium as gym
from gymnasium.wrappers import RecordVideo
from rich.console import Console
from rich.markup import escape

from vprbench.agents import label
from vprbench.bootstrap import intervals
from vprbench.catalogue import load_route
from vprbench.cli.words import plugin_config
from vprbench.encoder_store import EncoderStore
from vprbench.env import RouteEnv
from vprbench.episode import calibrate, judge, play
from vprbench.errors import ConfigError
from vprbench.fitted import fitted_agent
from vprbench.metrics import evaluate
from vprbench.protocols import DescriptorLocalizer, Localizer
from vprbench.response_matrix import ResponseMatrix
from vprbench.route import Route
from vprbench.trace import Trace
from vprbench.types import Observation

__all__ = ["Single", "run_command"]


@dataclass(frozen=True)
class Single:
    """The options of `vprbench run`; the command's help says what each means."""

    route: str
    agent: str
    distance: float
    seed: int
    data: Path | None
    routes: Path | None
    trace: Path | None
    video: Path | None
    cache: Path | None


def run_command(request: Single) -> None:
    """Play one cell through the environment and print its scores; faults are not caught, as in a sweep."""
    console, config = Console(), plugin_config(request.agent, "agent")
    _check_output("--trace", request.trace, ".parquet")
    _check_output("--video", request.video, ".mp4")
    if request.video is not None and find_spec("moviepy") is None:
        raise ConfigError("--video needs moviepy: pip install 'vprbench[video]'")
    route, aside = load_route(request.route, request.data, request.routes), Console(stderr=True)
    with aside.status("fit") as status:

        def report(stage: str, done: int, total: int, note: str = "") -> None:
            if stage == "fitted" and note:
                aside.print(escape(note), highlight=False, soft_wrap=True)
            status.update(escape(f"fit: {note}" if note else "fit"))

        store = EncoderStore.under(request.cache)
        localizer = fitted_agent(config, request.seed, route.training, store, report)
        status.update("find how densely to recruit")
        sampling = _sampling(localizer, route, request.distance)
        localizer.clear(sampling)
        status.update("learn, record and test")
        with _environment(route, localizer, request) as env:
            recording = play(env, localizer)
    trace = judge(route, recording, request.distance)
    if request.trace is not None:
        trace.save(request.trace)
    named = f"[bold]{escape(label(config))}[/bold] on {escape(route.name)}"
    console.print(f"{named}, a place every {request.distance:g} {route.unit}", highlight=False)
    console.print(f"{localizer.recruiting} {sampling:.6g}: {len(recording.place_frames)} places, {len(trace)} queries")
    _print_scores(trace, console)


def _check_output(option: str, path: Path | None, suffix: str) -> None:
    """Refuse what could not be written, before anything is measured."""
    if path is None:
        return
    if path.suffix.lower() != suffix:
        raise ConfigError(f"{option} {path}: give a file whose name ends in {suffix}")
    if not path.parent.is_dir():
        raise ConfigError(f"{option} {path}: there is no folder {path.parent}; make it first")


def _sampling(localizer: Localizer, route: Route, distance: float) -> float:
    """The vigilance or step for a sampling distance, the fast way where there is one to find."""
    if localizer.recruiting == "vigilance" and isinstance(localizer, DescriptorLocalizer):
        return ResponseMatrix(route, localizer).sampling(distance)
    return calibrate(localizer, route, distance)


def _print_scores(trace: Trace, console: Console) -> None:
    """Every metric in a line, with its interval where it has one."""
    spread = intervals(trace)
    for name, value in evaluate(trace).items():
        low, high = spread.get(f"{name}_low"), spread.get(f"{name}_high")
        interval = "" if low is None else f"   95 % {low:.4f} .. {high:.4f}"
        console.print(f"{name:36} {value:9.4f}{interval}", highlight=False)


class _Marked(gym.Wrapper[Observation, dict[str, Any], Observation, dict[str, Any]]):
    """Marks the focus points of the localizer's encoder, if it has one, on every rendered frame."""

    def __init__(self, env: RouteEnv, localizer: Localizer) -> None:
        super().__init__(env)
        self.route_env, self.encoder = env, getattr(localizer, "encoder", None)

    def reset(self, **options: Any) -> tuple[Observation, dict[str, Any]]:  # noqa: ANN401 - as Gymnasium has it
        observation, info = super().reset(**options)
        return self._mark(observation), info

    def step(self, action: dict[str, Any]) -> tuple[Observation, Any, bool, bool, dict[str, Any]]:
        observation, reward, ended, truncated, info = super().step(action)
        return self._mark(observation), reward, ended, truncated, info

    def _mark(self, observation: Observation) -> Observation:
        if self.encoder is not None:
            self.route_env.mark(self.encoder.encode(observation["frame"]).points)
        return observation


@contextmanager
def _environment(route: Route, localizer: Localizer, request: Single) -> Iterator[gym.Env[Any, Any]]:
    """The environment, its test phase filmed if that is asked for."""
    env = RouteEnv(route, request.distance, render_mode="rgb_array" if request.video else None)
    if request.video is None:
        yield env
        return
    with TemporaryDirectory() as folder:
        # Episodes count from 0: learn, record, test.
        films = Path(folder, "films")
        filmed = RecordVideo(_Marked(env, localizer), str(films), lambda episode: episode == 2, disable_logger=True)
        yield filmed
        filmed.close()
        shutil.move(next(films.glob("*.mp4")), request.video)
