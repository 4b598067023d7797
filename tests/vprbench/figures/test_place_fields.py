"""The drawing of place fields: where its lines, bars and labels stand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from matplotlib.text import Annotation

from vprbench.errors import ConfigError
from vprbench.figures.files import save_figure
from vprbench.figures.place_fields import place_field_figure
from vprbench.place_fields import PlaceFields


def tent(length: float, places: list[int], steepness: float = 0.1) -> PlaceFields:
    """A frame each metre from number 7 on; places whose response falls with the distance."""
    distance = np.arange(length + 1.0)
    responses = np.clip(1 - steepness * np.abs(distance[:, None] - distance[places]), 0, 1).astype(np.float32)
    winners = responses.argmax(axis=1) if places else np.full(len(distance), -1)
    frames, made = np.arange(len(distance)) + 7, np.array(places, np.int64)
    return PlaceFields("$Road$", "_agent", 4.0, distance, frames, made, winners, responses.reshape(len(distance), -1))


def dashes(axes: Axes) -> list[float]:
    return [float(np.asarray(line.get_xdata())[0]) for line in axes.lines if line.get_linestyle() == "--"]


def curves(axes: Axes) -> list[np.ndarray]:
    return [np.asarray(line.get_xydata()) for line in axes.lines if line.get_linestyle() == "-"]


def bars(axes: Axes) -> np.ndarray:
    """Left end, right end and height of each bar, along the road."""
    found = [patch for patch in axes.patches if isinstance(patch, Rectangle)]
    return np.array(sorted((bar.get_x(), bar.get_x() + bar.get_width(), bar.get_height()) for bar in found))


def test_places_stand_where_they_were_made_under_their_number_and_frame() -> None:
    (axes,) = place_field_figure(tent(12, [0, 5, 12])).axes
    assert dashes(axes) == [0, 5, 12]
    assert [text.get_text() for text in axes.texts] == ["0 (7)", "1 (12)", "2 (19)"]
    assert axes.get_xlim() == (0, 12)
    assert axes.get_ylim() == (0, 1)


def test_curves_are_the_responses() -> None:
    fields = tent(12, [0, 5, 12])
    (axes,) = place_field_figure(fields).axes
    for curve, response in zip(curves(axes), fields.responses.T, strict=True):
        np.testing.assert_allclose(curve, np.column_stack([fields.distance, response]))


def test_every_frame_is_filled_once_up_to_the_response_of_its_winner() -> None:
    fields = tent(12, [0, 5, 12])
    (axes,) = place_field_figure(fields).axes
    drawn = bars(axes)
    edges = [0, *np.arange(0.5, 12.0), 12]
    np.testing.assert_allclose(drawn[:, 0], edges[:-1])
    np.testing.assert_allclose(drawn[:, 1], edges[1:])
    np.testing.assert_allclose(drawn[:, 2], fields.responses.max(axis=1))


def test_a_long_road_is_broken_into_lines_that_name_each_place_once() -> None:
    figure = place_field_figure(tent(250, [0, 50, 125, 200, 250]))
    limits = [axes.get_xlim() for axes in figure.axes]
    np.testing.assert_allclose(limits, [(0, 250 / 3), (250 / 3, 500 / 3), (500 / 3, 250)])
    assert [len(axes.texts) for axes in figure.axes] == [2, 1, 2]
    assert [dash for axes in figure.axes for dash in dashes(axes)] == [0, 50, 125, 200, 250]


def test_many_places_take_more_lines_of_a_short_road() -> None:
    assert len(place_field_figure(tent(72, list(range(72)))).axes) == 2


def test_labels_of_near_places_are_pushed_apart_and_stay_in_the_figure() -> None:
    (axes,) = place_field_figure(tent(100, [10, 11, 12, 98, 99, 100])).axes
    at = np.array([text.xy[0] for text in axes.texts if isinstance(text, Annotation)])
    assert np.diff(at).min() >= 1.6 - 1e-9
    assert at.max() <= 100
    assert np.abs(at - dashes(axes)).max() < 4


def test_the_axis_begins_near_what_the_weakest_response_is() -> None:
    (axes,) = place_field_figure(tent(12, [0, 12], steepness=0.01)).axes
    assert axes.get_ylim() == (0.8, 1.0)


def test_frames_that_no_place_answers_are_counted() -> None:
    fields = tent(12, [0])
    fields.winners[5:8] = -1
    figure = place_field_figure(fields)
    assert len(bars(figure.axes[0])) == 10
    (said,) = (text.get_text().replace("\n", " ") for text in figure.texts if "record phase" in text.get_text())
    assert "No place answers at 3 of 13 frames" in said


def test_without_places_there_is_nothing_to_draw() -> None:
    with pytest.raises(ConfigError, match="_agent made no place on"):
        place_field_figure(tent(12, []))


def test_it_is_drawn_alike_again_and_names_are_no_mathematics(tmp_path: Path) -> None:
    for run in ("one", "two"):
        save_figure(place_field_figure(tent(12, [0, 5])), tmp_path / run, "fields")
    for kind in ("png", "svg"):
        assert (tmp_path / "one" / f"fields.{kind}").read_bytes() == (tmp_path / "two" / f"fields.{kind}").read_bytes()
    assert r"\$Road\$" in place_field_figure(tent(12, [0])).get_suptitle()
