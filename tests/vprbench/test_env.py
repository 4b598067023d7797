"""The environment: Gymnasium's own check, its wrappers, its phases and the truth it tells."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import InvalidAction, ResetNeeded
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers import FilterObservation, RecordEpisodeStatistics, RecordVideo

from vprbench.env import RouteEnv
from vprbench.errors import ConfigError, PhaseError
from vprbench.route import Route

IDS = ["vprbench/Street-Wide-v0", "vprbench/Street-Narrow-v0", "vprbench/Street-Mixed-v0"]


def act(place: int, confidence: float = 1.0) -> dict[str, Any]:
    return {"place": place, "confidence": np.float32(confidence)}


def drive(env: gym.Env[Any, Any], phase: str, places: list[int]) -> list[tuple[float, dict[str, Any]]]:
    """Play a phase with these answers; rewards and infos."""
    env.reset(options={"phase": phase})
    steps = [env.step(act(place)) for place in places]
    assert [step[2] for step in steps] == [False] * (len(places) - 1) + [True]
    return [(float(step[1]), step[4]) for step in steps]


@pytest.fixture
def env(toy_route: Route) -> RouteEnv:
    return RouteEnv(toy_route, sampling_distance=4.0)


@pytest.mark.parametrize("name", IDS)
def test_gymnasium_finds_no_fault(name: str) -> None:
    check_env(gym.make(name, render_mode="rgb_array").unwrapped)


@pytest.mark.kitti
def test_gymnasium_finds_no_fault_on_real_frames(kitti_root: Path) -> None:
    check_env(gym.make("vprbench/KITTI-K0-2-v0", data=kitti_root, render_mode="rgb_array").unwrapped)


def test_every_observation_lies_in_the_space(env: RouteEnv) -> None:
    observation, ended = env.reset()[0], False
    while not ended:
        assert observation in env.observation_space
        observation, _, ended, _, _ = env.step(act(-1, 0.0))
    assert observation in env.observation_space


def test_observations_are_copies(env: RouteEnv) -> None:
    first = env.reset()[0]
    for value in first.values():
        value[...] = 0  # type: ignore[index]
    again = env.reset()[0]
    assert again["frame"].any()
    assert again["camera"].tolist() == [372.0, 314.0]


def test_a_perfect_agent_is_always_right(env: RouteEnv, toy_route: Route) -> None:
    """Every learn frame is a place that wins at its own frame; the nearest one is answered."""
    learn, test = toy_route.learn.positions, toy_route.test.positions
    nearest = np.linalg.norm(test[:, None] - learn[None], axis=2).argmin(axis=1)
    frames = list(range(len(learn)))
    drive(env, "learn", frames)
    drive(env, "record", frames)
    steps = drive(env, "test", nearest.tolist())
    assert all(reward == 1.0 for reward, _ in steps)
    assert all(info["correct"] and info["correct_metric"] for _, info in steps)
    assert [info["true_place"] for _, info in steps] == nearest.tolist()
    assert [info["error_m"] for _, info in steps] == [info["tolerance_m"] for _, info in steps]


def test_truth_by_hand(env: RouteEnv) -> None:
    """Two places, at 10 m and 30 m, each winning on its half of the road."""
    drive(env, "learn", [-1] * 10 + [0] + [-1] * 19 + [1] + [-1] * 10)
    drive(env, "record", [0] * 20 + [1] * 21)
    steps = drive(env, "test", [0] * 30)
    north = env.route.test.positions[:, 1]
    # 0.4 m aside, so a query's answers are frames within its d_NN >= 0.4 m of the nearest one: itself alone,
    # except where the query lies midway (d_NN up to 0.64 m, still below the 1 m between frames).
    nearest = np.round(north).astype(int)
    assert [reward for reward, _ in steps] == (nearest < 20).astype(float).tolist()
    for (_, info), y in zip(steps, north, strict=True):
        assert info["error_m"] == pytest.approx(np.hypot(0.4, y - 10.0))
        assert info["correct_metric"] == (info["error_m"] <= 2.0 + info["tolerance_m"])


def test_no_answer_is_never_right(env: RouteEnv) -> None:
    drive(env, "learn", [0] + [-1] * 40)
    drive(env, "record", [-1] * 41)
    for reward, info in drive(env, "test", [-1] * 30):
        assert reward == 0.0
        assert not info["correct_metric"]
        assert np.isnan(info["error_m"])


def test_a_place_that_was_never_made_is_never_right(env: RouteEnv) -> None:
    drive(env, "learn", [0] + [-1] * 40)
    drive(env, "record", [7] * 41)
    assert not any(reward for reward, _ in drive(env, "test", [7] * 30))


def test_a_place_stays_where_it_was_first_made(env: RouteEnv) -> None:
    drive(env, "learn", [0, 0, 1] + [-1] * 38)
    assert env.place_frames[:3].tolist() == [0, 2, -1]


def test_learning_again_forgets(env: RouteEnv) -> None:
    drive(env, "learn", list(range(41)))
    drive(env, "record", list(range(41)))
    env.reset(options={"phase": "learn"})
    assert (env.place_frames == -1).all()
    with pytest.raises(PhaseError, match="record phase"):
        env.reset(options={"phase": "test"})


def test_a_finished_episode_needs_a_reset(env: RouteEnv) -> None:
    with pytest.raises(ResetNeeded):
        env.step(act(0))
    drive(env, "learn", [-1] * 41)
    with pytest.raises(ResetNeeded):
        env.step(act(0))


def test_phases_build_on_each_other(env: RouteEnv) -> None:
    with pytest.raises(PhaseError, match="play the learn phase"):
        env.reset(options={"phase": "record"})
    drive(env, "learn", [-1] * 41)
    with pytest.raises(PhaseError, match="play the record phase"):
        env.reset(options={"phase": "test"})
    with pytest.raises(ConfigError, match="did you mean 'record'"):
        env.reset(options={"phase": "recrod"})


@pytest.mark.parametrize("place", [-2, 41])
def test_a_place_outside_the_action_space_is_refused(env: RouteEnv, place: int) -> None:
    env.reset()
    with pytest.raises(InvalidAction, match=str(place)):
        env.step(act(place))


def test_gps_can_be_withheld(env: RouteEnv) -> None:
    blind = FilterObservation(env, ["frame", "heading", "camera"])
    observation, _ = blind.reset()
    assert set(observation) == {"frame", "heading", "camera"}


def test_statistics_count_the_right_answers(toy_route: Route) -> None:
    env = RecordEpisodeStatistics(RouteEnv(toy_route))
    drive(env, "learn", list(range(41)))
    drive(env, "record", [0] * 41)
    last = drive(env, "test", [0] * 30)[-1][1]
    assert last["episode"]["r"] == 30.0
    assert last["episode"]["l"] == 30


def drive_both(envs: gym.vector.VectorEnv[Any, Any, Any], phase: str, places: list[list[int]]) -> list[float]:
    """Play a phase with these answers, one list a copy; the sum of each copy's rewards."""
    _, info = envs.reset(options={"phase": phase})
    assert info["phase"].tolist() == [phase] * 2
    confidence = np.ones(2, np.float32)
    steps = [envs.step({"place": np.array(pair), "confidence": confidence}) for pair in zip(*places, strict=True)]
    assert [step[2].tolist() for step in steps] == [[False] * 2] * (len(steps) - 1) + [[True] * 2]
    return np.sum([step[1] for step in steps], axis=0).tolist()


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.DISABLED])
def test_copies_play_side_by_side(toy_route: Route, mode: AutoresetMode) -> None:
    """Test frame k is at 0.3 + 1.3586 k m: 15 lie nearest to learn frames 0..19, and 8 to frames 30..40."""
    options = {"autoreset_mode": mode}
    envs = gym.make_vec("vprbench/Route-v0", 2, vectorization_mode="sync", vector_kwargs=options, route=toy_route)
    made = [0] + [-1] * 19 + [1] + [-1] * 20
    assert drive_both(envs, "learn", [made, made]) == [0.0, 0.0]
    assert drive_both(envs, "record", [[0] * 20 + [1] * 21, [0] * 30 + [1] * 11]) == [0.0, 0.0]
    assert drive_both(envs, "test", [[0] * 30, [1] * 30]) == [15.0, 8.0]
    envs.close()


def test_a_step_after_the_end_begins_to_learn_by_default(toy_route: Route) -> None:
    nothing = {"place": np.array([-1]), "confidence": np.ones(1, np.float32)}
    envs = gym.make_vec("vprbench/Route-v0", vectorization_mode="sync", route=toy_route)
    envs.reset()
    for _ in range(41):
        envs.step(nothing)
    assert envs.step(nothing)[4]["phase"].tolist() == ["learn"]
    with pytest.raises(PhaseError, match="play the learn phase"):
        envs.reset(options={"phase": "record"})
    envs.close()


def test_an_episode_can_be_filmed(toy_route: Route, tmp_path: Path) -> None:
    env = RecordVideo(
        RouteEnv(toy_route, render_mode="rgb_array"), str(tmp_path / "film"), lambda _: True, disable_logger=True
    )
    drive(env, "learn", list(range(41)))
    env.close()
    assert [path.suffix for path in (tmp_path / "film").iterdir()] == [".mp4"]


def test_the_picture_shows_points_and_the_retrieved_place(toy_route: Route) -> None:
    env = RouteEnv(toy_route, render_mode="rgb_array")
    drive(env, "learn", list(range(41)))
    drive(env, "record", list(range(41)))
    env.reset(options={"phase": "test"})
    env.step(act(5))
    plain = env.render()
    env.reset(options={"phase": "test"})
    env.mark(np.array([[100.0, 100.0]], np.float32))
    env.step(act(5))
    marked = env.render()
    assert plain is not None and marked is not None
    assert plain.shape == (564, 642, 3)
    rows, columns = np.nonzero((plain != marked).any(axis=2))
    assert 0 < np.abs(rows - 100).max() <= 8 and np.abs(columns - 100).max() <= 8
    below_the_title = slice(30, 188)
    assert np.array_equal(plain[below_the_title, :, 0], toy_route.test.frames[0][below_the_title])
    assert np.array_equal(plain[188:376][below_the_title, :, 0], toy_route.learn.frames[5][below_the_title])
