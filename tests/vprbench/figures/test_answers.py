"""Drawings of answers: what their lines and marks say, held against the scores."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch

from vprbench.episode import Recording, judge
from vprbench.figures.curves import error_distribution, precision_recall
from vprbench.figures.files import save_figure
from vprbench.figures.maps import route_maps
from vprbench.figures.panels import Run
from vprbench.figures.sampling import metrics_by_distance
from vprbench.figures.sheet import Example, contact_sheet
from vprbench.figures.style import agent_colours
from vprbench.metrics import evaluate
from vprbench.route import Route
from vprbench.trace import Trace

COLOURS = {"$a$": "#0072B2", "_b": "#D55E00"}


@pytest.fixture(scope="module")
def runs(toy_route: Route) -> list[Run]:
    """Two agents that guess, the better the second, at two distances on one route."""
    made = []
    for noise, agent in ((1.0, "$a$"), (0.4, "_b")):
        for distance in (3.0, 5.0):
            rng = np.random.default_rng(int(distance))
            places = np.arange(0, len(toy_route.learn), int(distance))
            gaps = np.abs(toy_route.test.positions[:, 1, None] - toy_route.learn.positions[places, 1])
            responses = (np.exp(-gaps / 5) + noise * rng.random(gaps.shape)).astype(np.float32) / 2
            winners = np.arange(len(toy_route.learn)) // int(distance)
            made.append(
                Run("toy", distance, agent, 0, judge(toy_route, Recording(places, winners, responses), distance))
            )
    return made


def texts(figure: Figure) -> set[str]:
    """Everything that is written in a figure, as it is drawn."""
    figure.draw_without_rendering()
    from matplotlib.text import Text

    return {text.get_text() for text in figure.findobj(Text) if isinstance(text, Text)}


def test_the_area_under_a_curve_is_the_auc_and_it_ends_at_the_accuracy(runs: list[Run]) -> None:
    figure = precision_recall(runs, COLOURS)
    for panel, distance in zip(figure.axes, (3.0, 5.0), strict=True):
        for run in (run for run in runs if run.distance == distance):
            line, end = (one for one in panel.lines if one.get_color() == COLOURS[run.agent])
            recall, precision = np.asarray(line.get_data(), float)
            scores = evaluate(run.trace)
            assert np.trapezoid(precision, recall) == pytest.approx(scores["auc_all"])
            assert np.asarray(end.get_xdata(), float)[0] == pytest.approx(scores["accuracy"])


def test_half_of_the_answers_lie_within_the_median_error(runs: list[Run]) -> None:
    silent = runs[0].trace.to_frame()
    silent.loc[:9, ["hypothesis", "confidence", "error_m", "correct", "correct_metric"]] = [
        -1,
        0.0,
        np.nan,
        False,
        False,
    ]
    silent.loc[:9, ["rank", "rank_metric"]] = -1
    cases = [*runs, runs[0]._replace(agent="_b", distance=9.0, trace=Trace.from_frame(silent))]
    figure = error_distribution(cases, COLOURS)
    for panel, distance in zip(figure.axes, (3.0, 5.0, 9.0), strict=True):
        for run in (run for run in cases if run.distance == distance):
            (line,) = (one for one in panel.lines if one.get_color() == COLOURS[run.agent])
            error, share = np.asarray(line.get_data(), float)
            errors = run.trace.error_m
            assert share[-1] == pytest.approx(np.isfinite(errors).mean())
            for metres in (1.0, 5.0, 20.0):
                expected = (errors <= metres).mean()
                assert share[error <= metres][-1] == pytest.approx(expected)


def test_errors_of_a_route_in_frames_are_in_frames(runs: list[Run]) -> None:
    assert "error, m" in texts(error_distribution(runs, COLOURS))
    assert "error, frames" in texts(error_distribution(runs, COLOURS, "frames"))


def test_a_line_is_the_mean_over_seeds_and_its_band_holds_their_intervals() -> None:
    rows = pd.DataFrame(
        [
            {"route": "r", "agent": "$a$", "sampling_distance_m": 2.0, "m": 0.5, "m_low": 0.4, "m_high": 0.6},
            {"route": "r", "agent": "$a$", "sampling_distance_m": 2.0, "m": 0.7, "m_low": 0.5, "m_high": 0.9},
            {"route": "r", "agent": "$a$", "sampling_distance_m": 5.0, "m": 0.8, "m_low": 0.7, "m_high": 0.85},
        ]
    )
    figure = metrics_by_distance(rows, {"m": "a metric"}, COLOURS)
    (panel,) = figure.axes
    assert np.asarray(panel.lines[0].get_data(), float).tolist() == [[2, 5], pytest.approx([60, 80])]
    bars, band = panel.collections
    assert [np.asarray(bar)[:, 1].tolist() for bar in bars.get_segments()] == [  # type: ignore[attr-defined]
        pytest.approx([40, 90]),
        pytest.approx([70, 85]),
    ]
    corners = band.get_paths()[0].vertices
    assert sorted(set(np.round(np.asarray(corners)[:, 1], 6))) == [40, 70, 85, 90]
    assert {"$a$", "a metric", "r\n%"} <= {text.replace(r"\$", "$") for text in texts(figure)}


def test_many_agents_have_bars_beside_each_other() -> None:
    names = [f"agent {number}" for number in range(5)]
    rows = pd.DataFrame(
        {"route": "r", "agent": name, "sampling_distance_m": distance, "m": 0.5, "m_low": 0.4, "m_high": 0.6}
        for name in names
        for distance in (2.0, 3.0, 5.0)
    )
    (panel,) = metrics_by_distance(rows, {"m": "a metric"}, agent_colours(names)).axes
    places = [np.asarray(line.get_xdata(), float)[0] for line in panel.lines]
    assert places == pytest.approx([1.75, 1.875, 2.0, 2.125, 2.25])
    assert len(panel.collections) == 5


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0, 4.5])
def test_maps_keep_lengths_show_north_and_every_query_once(runs: list[Run], angle: float) -> None:
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    first = runs[0].trace.to_frame()
    road = first[["east", "north"]].to_numpy() @ turned
    run = runs[0]._replace(trace=Trace.from_frame(first.assign(east=road[:, 0], north=road[:, 1])))
    figure = route_maps([run])
    (panel,) = figure.axes
    points = np.concatenate([np.asarray(kind.get_offsets(), float) for kind in panel.collections])
    assert len(points) == len(road)
    right = np.asarray(panel.collections[0].get_offsets(), float)
    driven = road[run.trace.correct]
    drawn_gaps, driven_gaps = (np.linalg.norm(p[:, None] - p[None], axis=2) for p in (right, driven))
    np.testing.assert_allclose(drawn_gaps, driven_gaps, atol=1e-9)
    # The road runs along one line, which lies across; north points where the road's own north went, never down.
    assert np.ptp(right[:, 0]) > 100 * np.ptp(right[:, 1])
    (arrow,) = figure.findobj(FancyArrowPatch)
    corners = np.asarray(arrow.get_path().vertices, float)
    heading = corners[2] - corners[0]
    assert heading[1] >= -1e-9
    assert abs(heading[0] / np.hypot(*heading)) == pytest.approx(abs(np.cos(angle)), abs=0.02)


def test_kinds_of_answers_are_those_of_the_trace(runs: list[Run]) -> None:
    trace = runs[0].trace
    panel = route_maps(runs[:1]).axes[0]
    counts = [len(np.asarray(kind.get_offsets())) for kind in panel.collections]
    near = int((trace.correct_metric & ~trace.correct).sum())
    assert counts == [trace.correct.sum(), near, len(trace) - trace.correct.sum() - near, 0]


def test_names_are_printed_to_the_letter(runs: list[Run]) -> None:
    for figure in (precision_recall(runs, COLOURS), error_distribution(runs, COLOURS), route_maps(runs)):
        said = " ".join(texts(figure))
        assert r"\$a\$" in said
        assert " _b" in said


def test_a_sheet_shows_the_frames_and_the_lack_of_one(
    toy_route: Route, tmp_path_factory: pytest.TempPathFactory
) -> None:
    frame = toy_route.test.frames[3]
    figure = contact_sheet([Example("first", True, frame, frame, frame), Example("second", False, frame, None, frame)])
    assert {"first", "second", "no frame", "query", "retrieved"} <= texts(figure)
    pictures = [image.get_array() for panel in figure.axes for image in panel.images]
    assert len(pictures) == 5
    assert all(np.array_equal(np.asarray(picture), frame) for picture in pictures)
    assert save_figure(figure, tmp_path_factory.mktemp("sheet"), "sheet").png.stat().st_size > 10_000
