"""Gardens Point and Nordland: routes whose truth is the number of a frame, through the catalogue to a row."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from vprbench.catalogue import catalogue, load_route
from vprbench.env import RouteEnv
from vprbench.episode import play
from vprbench.errors import ConfigError, DataError
from vprbench.fitted import fitted_agent
from vprbench.frequency.filling import Filling
from vprbench.runner import run
from vprbench.sweep import Cell, Job

Writer = Callable[..., None]

ENTRY = """[routes.walk]
reader = "index"
learn = "day_left:0-19"
test = "night_right:0-19"
training = ["day_left:40-49"]
tolerance = 2
"""


@pytest.fixture
def routes(tmp_path: Path, draw_view: Writer) -> Path:
    """Two walks of 20 frames along one wall, the second 3 pixels aside; and frames further on to train on."""
    for number in (*range(20), *range(40, 50)):
        draw_view(tmp_path / "day_left" / f"Image{number:03d}.png", number)
    for number in range(20):
        draw_view(tmp_path / "night_right" / f"Image{number:03d}.jpg", number)
    (tmp_path / "my.toml").write_text(ENTRY)
    return tmp_path / "my.toml"


def answer(routes: Path, config: dict[str, Any], distance: float = 3.0) -> dict[str, Any]:
    cell = Cell("walk", "agent", distance, 0)
    (outcome,) = run(Job("walk", "agent", 0, config, (cell,)), routes_file=routes)
    return outcome.row


def test_the_truth_is_the_number(routes: Path) -> None:
    route = load_route("walk", routes=routes)
    assert (route.unit, route.learn.heading_source) == ("frames", "absent")
    near = np.abs(np.arange(20)[:, None] - np.arange(20)[None]) <= 2
    assert np.array_equal(route.visit.answers, near)
    assert route.visit.rule == "learn frames within 2 frames of the query"


def test_a_row_says_its_unit_its_rule_and_that_it_had_no_headings(routes: Path) -> None:
    row = answer(routes, {"localizer": "cohog"})
    assert row["error"] == ""
    assert (row["unit"], row["heading_source"]) == ("frames", "absent")
    assert row["tolerance_rule"] == "learn frames within 2 frames of the query"
    assert row["interval_rule"].endswith("blocks of 10 frames")
    # A frame every three, from 0 to 18; the drive is 19 frames long.
    assert (row["places"], row["place_spacing_m"]) == (7, pytest.approx(19 / 7))
    assert row["tolerance_mean_m"] == 2.0
    assert row["accuracy"] == 1.0


def test_max_pi_without_azimuths_runs_and_with_them_refuses(routes: Path) -> None:
    agent = {"localizer": "max-pi", "encoder": "log-polar-6", "different_places": 5.0}
    refused = answer(routes, agent)
    assert refused["status"] == "failed"
    assert "no headings" in refused["error"]
    assert "set azimuth_width_deg = inf" in refused["error"]
    row = answer(routes, {**agent, "azimuth_width_deg": float("inf")})
    assert row["error"] == ""
    assert row["accuracy"] > 0.8


def test_the_environment_has_no_heading_to_sense(routes: Path) -> None:
    env = RouteEnv(load_route("walk", routes=routes), 3.0)
    check_env(env, skip_render_check=True)
    observation, _ = env.reset()
    assert set(observation) == {"frame", "camera", "gps"}
    assert observation["gps"].tolist() == [0, 0]


def test_a_memory_filled_from_such_a_route_has_no_headings(routes: Path) -> None:
    filling = Filling(load_route("walk", routes=routes), 25)
    assert {len(filling[index].observation) for index in (0, 21, 60)} == {3}
    assert "heading" not in filling[0].observation


def test_frame_by_frame_the_same_truth_is_told(routes: Path) -> None:
    route = load_route("walk", routes=routes)
    localizer = fitted_agent({"localizer": "cohog"}, 0, route.training)
    localizer.clear(3.0)
    env = RouteEnv(route, 3.0)
    play(env, localizer)
    env.reset(options={"phase": "test"})
    _, reward, _, _, info = env.step({"place": 5, "confidence": np.float32(1)})
    # Place 5 was made at frame 15; the first query's answers are frames 0 to 2.
    assert (reward, info["error_m"], info["tolerance_m"], info["correct_metric"]) == (0.0, 15.0, 2.0, False)
    assert info["true_place"] == 0


def test_every_other_frame_of_both_drives(routes: Path) -> None:
    routes.write_text(ENTRY + "every = 2\n")
    route = load_route("walk", routes=routes)
    assert route.learn.indices.tolist() == route.test.indices.tolist() == list(range(0, 20, 2))
    assert np.flatnonzero(route.visit.answers[2]).tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("0-19", "0-21", "frames 0-21 of .*: 20 of 22 are in .*night_right, missing 20-21"),
        ("night_right:0-19", "day_left:10-39", r"0-19 and .*day_left:10-39 share the image .*010\.png and 9 more"),
        ("night_right:0-19", "day_left:40-49", "share the image"),
        ("night_right", "night_left", "night_left"),
        ("tolerance = 2", "tolerance = 2\nheading_noise_deg = 3", "no headings that could be noisy"),
    ],
)
def test_data_that_do_not_fit_are_refused(routes: Path, draw_view: Writer, old: str, new: str, fault: str) -> None:
    for number in range(20, 40):
        draw_view(routes.parent / "day_left" / f"Image{number:03d}.png", number)
    routes.write_text(ENTRY.replace(old, new))
    with pytest.raises(DataError, match=fault) as error:
        load_route("walk", routes=routes)
    assert "\n" not in str(error.value)


def test_drives_without_a_common_number_are_no_route(routes: Path, draw_view: Writer) -> None:
    for number in range(70, 80):
        draw_view(routes.parent / "late" / f"{number}.png", number)
    routes.write_text(ENTRY.replace("night_right:0-19", "late"))
    with pytest.raises(DataError, match=r"walk: no test frame has a right learn frame .*10 of 10 queries have none"):
        load_route("walk", routes=routes)


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ('"day_left:0-19"', '"day_left:19-0"', r"\.learn: 'day_left:19-0' ends before it has two frames"),
        ('"day_left:0-19"', "3", r"\.learn: 3 is neither \"folder\" nor \"folder:first-last\""),
        ("tolerance = 2", "tolerance = -1", r"\.tolerance: should be greater than or equal to 0, not -1"),
        ("tolerance = 2", "tolerance = 2\ntolerence = 2", r"\.tolerence: unknown key: did you mean 'tolerance'\?"),
        ("tolerance = 2", 'tolerance = 2\ncrop = "middle"', r"\.crop: 'middle' is neither \"centre\" nor a table"),
        ("tolerance = 2", "tolerance = 2\ncrop = { tpo = 3 }", r"\.crop\.tpo: unknown key: did you mean 'top'\?"),
    ],
)
def test_a_bad_entry_is_met_by_its_key(routes: Path, old: str, new: str, fault: str) -> None:
    routes.write_text(ENTRY.replace(old, new))
    with pytest.raises(ConfigError, match=r"my\.toml: routes\.walk" + fault):
        catalogue(routes)
