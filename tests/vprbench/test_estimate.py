"""Estimates against the work that a job really does, counted, and timed by a clock that the localizer turns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from jaxtyping import Float32

from vprbench import estimate as module
from vprbench.encoder_store import EncoderStore
from vprbench.estimate import Estimator
from vprbench.frame_memory import FrameMemory
from vprbench.pool import Settings
from vprbench.protocols import Recruiting
from vprbench.recruiting import Odometer
from vprbench.route import FrameSource, Route, Traverse
from vprbench.runner import run
from vprbench.sweep import Cell, Job
from vprbench.types import Frame, Landmarks, Observation, Responses

Signatures = Float32[np.ndarray, "rows size"]

JOB = Job("toy", "fake", 0, {"localizer": "fake"}, tuple(Cell("toy", "fake", float(d), 0) for d in (4, 8)))
SECONDS_A_FRAME, SECONDS_A_PLACE, SECONDS_TO_READ = 3.0, 0.25, 2.0


class Fake:
    """A localizer that counts what it does, and takes its time by its own clock."""

    def __init__(self, recruiting: Recruiting) -> None:
        self.recruiting = recruiting
        self.fitted = self.played = 0
        self.now = 0.0

    def fit(self, drives: Sequence[Sequence[Observation]]) -> None:
        self.fitted += sum(1 for drive in drives for _ in drive)

    def clear(self, sampling: float) -> None:
        self.sampling, self.odometer, self.places = sampling, Odometer(sampling), list[float]()

    def learn(self, observation: Observation) -> int | None:
        due = self.odometer.due(observation["gps"])
        if self.recruiting == "vigilance":
            due = max(self.respond(observation), default=0.0) < self.sampling
        else:
            self._look()
        if not due:
            return None
        self.places.append(float(observation["frame"].mean()))
        return len(self.places) - 1

    def respond(self, observation: Observation) -> Responses:
        self._look()
        self.now += SECONDS_A_PLACE * len(self.places)
        away = np.abs(np.array(self.places) - observation["frame"].mean())
        return np.asarray(1 / (1 + away / 10), np.float32)

    def _look(self) -> None:
        self.played += 1
        self.now += SECONDS_A_FRAME


@pytest.fixture
def fake(request: pytest.FixtureRequest, toy_route: Route, monkeypatch: pytest.MonkeyPatch) -> Fake:
    made = Fake(request.param)
    for module_name in ("vprbench.estimate", "vprbench.fitted"):
        monkeypatch.setattr(f"{module_name}.build", lambda config, seed, encoder=None: made)
    for module_name in ("vprbench.estimate", "vprbench.runner"):
        monkeypatch.setattr(f"{module_name}.load_route", lambda *names, **paths: toy_route)
    monkeypatch.setattr(module, "process_time", lambda: made.now)
    monkeypatch.setattr("vprbench.runner.normalise", lambda config: config)
    monkeypatch.setattr("vprbench.runner.origins", lambda config: "", raising=False)
    return made


@pytest.mark.parametrize("fake", ["step"], indirect=True)
def test_the_work_of_a_step_localizer_is_known_beforehand(fake: Fake) -> None:
    said = Estimator(Settings()).estimate(JOB)
    fake.fitted, fake.played, fake.now = 0, 0, 0.0
    outcomes = list(run(JOB))
    assert [outcome.row["error"] for outcome in outcomes] == ["", ""]
    assert said.pairs == 0
    assert said.frames == fake.fitted + fake.played
    # The road makes 10 and 5 places; the last frame adds one to each.
    assert said.seconds == pytest.approx(fake.now, rel=0.05)


@pytest.mark.parametrize("fake", ["vigilance"], indirect=True)
def test_the_vigilances_tried_are_counted(fake: Fake) -> None:
    said = Estimator(Settings()).estimate(JOB)
    # Of 41 learn and 30 test frames: 9 times learned, then recorded and tested, for two cells; 10 trained.
    assert said.frames == 2 * (9 * 41 + 41 + 30) + 10
    assert said.pairs == 0
    fake.fitted, fake.played, fake.now = 0, 0, 0.0
    list(run(JOB))
    # As `--dry-run` promises, within a factor of 2.
    assert 0.5 < said.frames / fake.played < 2
    assert 0.5 < said.seconds / fake.now < 2


def test_what_a_matrix_keeps_is_known_beforehand(toy_route: Route, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vprbench.estimate.load_route", lambda *names, **paths: toy_route)
    said = Estimator(Settings()).estimate(replace(JOB, config="cohog"))
    # 32 x 32 cells of 8 values, as many norms and as many weights, of 41 learn and 30 test frames.
    assert said.bytes == pytest.approx(71 * 32 * 32 * 10 * 4 + 41 * 71 * 4, rel=0.02)


@dataclass
class SlowFrames:
    """Frames that take their time to read, by the clock of the localizer."""

    source: FrameSource
    fake: Fake

    def __getitem__(self, index: int, /) -> Frame:
        self.fake.now += SECONDS_TO_READ
        return self.source[index]


@pytest.fixture
def slowly_read(fake: Fake, toy_route: Route, monkeypatch: pytest.MonkeyPatch) -> Route:
    def slow(drive: Traverse) -> Traverse:
        return replace(drive, frames=SlowFrames(drive.frames, fake))

    training = tuple(map(slow, toy_route.training))
    made = replace(toy_route, learn=slow(toy_route.learn), test=slow(toy_route.test), training=training)
    for module_name in ("vprbench.estimate", "vprbench.runner"):
        monkeypatch.setattr(f"{module_name}.load_route", lambda *names, **paths: made)
    return made


@pytest.mark.parametrize("fake", ["step"], indirect=True)
def test_the_frames_of_a_route_are_charged_to_the_first_of_its_jobs(fake: Fake, slowly_read: Route) -> None:
    others = [replace(JOB, seed=1), replace(JOB, cells=tuple(Cell("toy", "fake", float(d), 0) for d in (5, 10)))]
    estimator = Estimator(Settings())
    said = [estimator.estimate(job).seconds for job in (JOB, *others)]
    assert said[0] - said[1] == pytest.approx(SECONDS_TO_READ * (41 + 30 + 10))
    fake.now, memory = 0.0, FrameMemory()
    for job in (JOB, *others):
        assert all(outcome.row["error"] == "" for outcome in run(job, memory=memory))
    assert sum(said) == pytest.approx(fake.now, rel=0.05)


@pytest.mark.parametrize("fake", ["step"], indirect=True)
def test_frames_for_which_there_is_no_room_are_charged_to_every_job(fake: Fake, slowly_read: Route) -> None:
    seconds = []
    for limit in (1000, 50):
        estimator = Estimator(Settings())
        object.__setattr__(estimator, "_memory", FrameMemory(limit))
        estimator.estimate(JOB)
        seconds.append(estimator.estimate(replace(JOB, seed=1)).seconds)
    assert seconds[1] - seconds[0] == pytest.approx(SECONDS_TO_READ * (41 + 30 - 50))


class Learner:
    """An encoder that takes `base` seconds by its own clock, times the square root of the frames, to learn."""

    now = 0.0

    def __init__(self, base: float) -> None:
        self.base = base

    def fit(self, frames: Sequence[Frame]) -> None:
        Learner.now += self.base * len(frames) ** 0.5

    def encode(self, frame: Frame) -> Landmarks:
        return Landmarks(np.zeros((1, 1), np.float32), np.zeros((1, 2), np.float32))

    def match(self, queries: Signatures, memory: Signatures) -> Signatures:
        return np.ones((len(queries), len(memory)), np.float32)

    def save(self, path: Path | str) -> None:
        Path(path).write_text(str(self.base))

    @classmethod
    def load(cls, path: Path | str) -> Learner:
        return cls(float(Path(path).read_text()))


LEARNING = {"localizer": "fake", "encoder": {"name": "learner"}}


def job(seed: int, agent: str = "one") -> Job:
    return Job("toy", agent, seed, LEARNING, (Cell("toy", agent, 4.0, seed),))


@pytest.fixture
def learner(toy_route: Route, monkeypatch: pytest.MonkeyPatch) -> Route:
    monkeypatch.setattr(module, "load_route", lambda *names, **paths: toy_route)
    monkeypatch.setattr(module, "build_encoder", lambda config, seed: Learner(6.0))
    monkeypatch.setattr(module, "build", lambda config, seed, encoder=None: Fake("step"))
    monkeypatch.setattr(module, "encoder_key", lambda config, seed, encoder, training: f"learner-s{seed}")
    monkeypatch.setattr(module, "process_time", lambda: Learner.now)
    return toy_route


def test_a_fit_is_charged_to_the_first_job_that_needs_it(learner: Route, tmp_path: Path) -> None:
    store = EncoderStore(tmp_path)
    tmp_path.joinpath("learner-s2.npz").touch()
    estimator = Estimator(Settings(store=store))
    seconds = [estimator.estimate(each).seconds for each in (job(0), job(0, "two"), job(1), job(2))]
    whole = 6.0 * sum(map(len, learner.training)) ** 0.5
    assert seconds == pytest.approx([whole, 0.0, whole, 0.0])


def test_without_a_store_every_job_fits_anew(learner: Route) -> None:
    estimator = Estimator(Settings())
    first, second = (estimator.estimate(job(0, agent)).seconds for agent in ("one", "two"))
    assert first == second > 0


def test_jobs_that_differ_in_their_seed_alone_are_measured_once(learner: Route) -> None:
    estimator = Estimator(Settings())
    estimator.estimate(job(0))
    before = Learner.now
    estimator.estimate(job(1))
    assert Learner.now == before
