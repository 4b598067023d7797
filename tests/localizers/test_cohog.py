from __future__ import annotations

from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.agents import build
from vprbench.catalogue import load_route
from vprbench.checks import Check, parametrize_with_checks
from vprbench.checks.samples import drive, flat_frame, textured_frame
from vprbench.errors import ConfigError, DataError
from vprbench.observation import Drive
from vprbench.protocols import DescriptorLocalizer
from vprbench.route import Route
from vprbench.types import Frame, Observation, hypothesis
from vprbench_localizers.cohog import CoHOG
from vprbench_localizers.region_match import Description, describe_regions


@parametrize_with_checks(localizer=CoHOG)
def test_cohog_conforms(check: Check) -> None:
    check.run()


class Blindfolded(CoHOG):
    """CoHOG that recruits as ever but looks at nothing, so that a long drive is quick."""

    nothing = describe_regions(np.zeros((32, 32, 8)), np.zeros((31, 31), bool))

    def describe(self, observation: Observation) -> Description:
        return self.nothing


def at(east: float, north: float = 0.0, frame: Frame | None = None) -> Observation:
    frame = flat_frame(9) if frame is None else frame
    return Observation(frame=frame, heading=np.zeros(1), camera=np.array([370.0, 314.0]), gps=np.array([east, north]))


def recruited(localizer: CoHOG, road: list[Observation]) -> list[int]:
    return [index for index, seen in enumerate(road) if localizer.learn(seen) is not None]


def test_it_is_built_from_its_name_and_describes_frames_one_by_one() -> None:
    localizer = build({"localizer": "cohog", "magnitude": "hypot"})
    assert isinstance(localizer, CoHOG)
    assert isinstance(localizer, DescriptorLocalizer)


def test_a_place_is_recruited_at_each_step_of_road() -> None:
    road = [at(east) for east in (0.0, 1.0, 2.75, 3.0, 5.9, 6.1, 12.0, 12.5)]
    assert recruited(Blindfolded(step=3.0), road) == [0, 3, 5, 6]


def test_the_road_counts_and_not_the_distance_as_the_crow_flies() -> None:
    there_and_back = [at(0.0), at(1.0, 1.0), at(0.0), at(1.0, 1.0)]
    assert recruited(Blindfolded(step=4.0), there_and_back) == [0, 3]


def test_a_step_of_zero_makes_every_frame_a_place() -> None:
    assert recruited(Blindfolded(step=0.0), [at(0.0)] * 4) == [0, 1, 2, 3]


@given(
    strides=st.lists(st.floats(0.01, 2.0), min_size=1, max_size=80),
    turns=st.floats(-0.5, 0.5),
    step=st.floats(0.5, 20.0),
)
def test_there_is_a_place_for_each_step_of_the_length(strides: list[float], turns: float, step: float) -> None:
    directions = turns * np.arange(len(strides))
    east, north = np.cumsum(np.array(strides) * [np.cos(directions), np.sin(directions)], axis=1)
    road = [at(0.0), *(at(*position) for position in zip(east, north, strict=True))]
    places, length = len(recruited(Blindfolded(step=step), road)), sum(strides)
    # Each place but the last is followed by a step of road, and by less than one stride more than that.
    assert places <= length / step + 1 + 1e-9
    assert places > length / (step + max(strides))


def test_streaming_gives_bit_by_bit_what_the_matrix_gives(toy_route: Route) -> None:
    localizer = CoHOG(step=4.0)
    places = [seen for seen in Drive(toy_route.learn) if localizer.learn(seen) is not None]
    queries = Drive(toy_route.test, gps=False)[::4]
    streamed = np.stack([localizer.respond(query) for query in queries])
    described = [[localizer.describe(seen) for seen in seens] for seens in (queries, places)]
    assert streamed.shape == (8, 11)
    np.testing.assert_array_equal(localizer.compare(*described), streamed)


@pytest.mark.kitti
@pytest.mark.parametrize("threads", [1, 2])
def test_it_locates_on_a_street_what_responds_most(kitti_root: Path, threads: int) -> None:
    route, localizer = load_route("KITTI-K0-2", data=kitti_root), CoHOG(step=2.0, threads=threads)
    for seen in Drive(route.learn):
        localizer.learn(seen)
    for query in Drive(route.test, gps=False)[::16]:
        assert localizer.locate(query) == hypothesis(localizer.respond(query))


@pytest.mark.kitti
def test_it_recognises_a_street_seen_before(kitti_root: Path) -> None:
    route, localizer = load_route("KITTI-K0-2", data=kitti_root), CoHOG(step=3.0)
    where = np.array([seen["gps"] for seen in Drive(route.learn) if localizer.learn(seen) is not None])
    queries = Drive(route.test)[::8]
    best = [where[hypothesis(localizer.respond(query)).place] for query in queries]
    errors = np.linalg.norm(best - np.array([query["gps"] for query in queries]), axis=1)
    assert np.median(errors) < 1.5
    assert (errors < 3.0).mean() >= 0.9


def test_nothing_compares_to_nothing() -> None:
    localizer = CoHOG()
    described = [localizer.describe(seen) for seen in drive(2)]
    assert localizer.compare(described, []).shape == (2, 0)
    assert localizer.compare([], described).shape == (0, 2)


@pytest.mark.parametrize("threshold", [0.0, 0.4])
@pytest.mark.parametrize("grey", [0, 1, 128, 255])
def test_a_uniform_frame_responds_to_nothing_and_nothing_to_it(grey: int, threshold: float) -> None:
    localizer = CoHOG(step=1.0, entropy_threshold=threshold)
    flat, view = at(0.0, frame=flat_frame(grey)), at(9.0, frame=textured_frame(1))
    localizer.learn(flat)
    localizer.learn(view)
    assert localizer.respond(flat).tolist() == [0.0, 0.0]
    assert localizer.respond(view).tolist() == [0.0, pytest.approx(1.0)]


def test_learning_needs_gps() -> None:
    blind = Observation(frame=flat_frame(9), heading=np.zeros(1), camera=np.array([370.0, 314.0]))
    with pytest.raises(DataError, match="gps"):
        CoHOG().learn(blind)


@pytest.mark.parametrize("frame", [np.zeros((188, 642, 3), np.uint8), np.zeros((188, 642))])
def test_a_frame_that_is_not_grey_bytes_is_refused(frame: Any) -> None:  # noqa: ANN401 - the fault is its type
    with pytest.raises(DataError, match="grey uint8"):
        CoHOG().respond(at(0.0, frame=frame))


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"step": -1.0}, "step must be"),
        ({"step": nan}, "step must be"),
        ({"step": inf}, "step must be"),
        ({"entropy_threshold": 1.5}, "entropy_threshold must be"),
        ({"entropy_threshold": nan}, "entropy_threshold must be"),
        ({"threads": 0}, "threads must be"),
        ({"magnitude": "hypo"}, "did you mean 'hypot'"),
    ],
)
def test_an_option_out_of_range_is_refused(options: dict[str, Any], text: str) -> None:
    with pytest.raises(ConfigError, match=text):
        CoHOG(**options)
