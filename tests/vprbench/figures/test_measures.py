from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.container import BarContainer, ErrorbarContainer
from matplotlib.figure import Figure

from vprbench.errors import ConfigError
from vprbench.figures.files import save_figure
from vprbench.figures.measures import measure_bars
from vprbench.figures.style import COLOURS

# By hand: means 4, 0.5 and 0.7; standard deviations 2 (of 2, 4, 6), 0.1 sqrt(2) (of 0.4, 0.6), none of one seed.
FRAME = pd.DataFrame(
    {
        "encoder": ["zeta", "alpha", "zeta", "alpha", "zeta", "mid"],
        "seed": [0, 0, 1, 1, 2, 0],
        "rate": [2.0, 0.4, 4.0, 0.6, 6.0, 0.7],
        "rate_held_out": [1.0, np.nan, 1.0, np.nan, 4.0, 0.2],
    }
)


def bars(axes: Axes) -> list[tuple[float, float]]:
    """Centre and height of each bar, in the order of drawing."""
    patches = [patch for container in axes.containers if isinstance(container, BarContainer) for patch in container]
    return [(patch.get_x() + patch.get_width() / 2, patch.get_height()) for patch in patches]


def whiskers(axes: Axes) -> list[tuple[float, float, float]]:
    """Place, lower and upper end of each whisker."""
    lines = [c.lines[2][0] for c in axes.containers if isinstance(c, ErrorbarContainer)]
    ends = [np.asarray(line.get_segments()[0]) for line in lines]
    return [(segment[0, 0], segment[0, 1], segment[1, 1]) for segment in ends]


def dots(axes: Axes) -> list[list[float]]:
    return [list(np.asarray(line.get_ydata())) for line in axes.lines if line.get_marker() == "o"]


def written(figure: Figure) -> str:
    return " ".join(" ".join(text.get_text() for text in figure.texts).split())


def test_bars_are_means_in_the_order_of_first_appearance() -> None:
    (axes,) = measure_bars(FRAME, ["rate"], axis="rate, x").axes
    np.testing.assert_allclose(bars(axes), [(0, 4), (1, 0.5), (2, 0.7)])
    assert [label.get_text() for label in axes.get_xticklabels()] == ["zeta", "alpha", "mid"]
    assert list(axes.get_xticks()) == [0, 1, 2]
    assert axes.get_ylabel() == "rate, x"
    assert axes.get_ylim()[0] == 0


def test_whiskers_reach_one_sd_and_one_seed_has_none() -> None:
    (axes,) = measure_bars(FRAME, ["rate"]).axes
    sd = 0.1 * np.sqrt(2)
    np.testing.assert_allclose(whiskers(axes), [(0, 2, 6), (1, 0.5 - sd, 0.5 + sd)])


def test_dots_are_the_seeds_and_stand_within_their_bar() -> None:
    (axes,) = measure_bars(FRAME, ["rate"]).axes
    assert dots(axes) == [[2, 4, 6], [0.4, 0.6]]
    for line, (centre, _) in zip((line for line in axes.lines if line.get_marker() == "o"), bars(axes), strict=False):
        assert np.abs(np.asarray(line.get_xdata()) - centre).max() < 0.4


def test_bars_of_measures_stand_side_by_side_and_unknown_ones_are_left_out() -> None:
    figure = measure_bars(FRAME, ["rate", "rate_held_out"], names={"rate": "seen"})
    (axes,) = figure.axes
    np.testing.assert_allclose(bars(axes), [(-0.2, 4), (0.8, 0.5), (1.8, 0.7), (0.2, 2), (2.2, 0.2)])
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["seen", "rate, held out"]


def test_held_out_is_the_paler_of_one_colour() -> None:
    (axes,) = measure_bars(FRAME, ["rate", "rate_held_out"]).axes
    edges = {to_hex(patch.get_edgecolor()).upper() for patch in axes.patches}
    faces = [to_hex(patch.get_facecolor()).upper() for patch in axes.patches]
    assert edges == {COLOURS[0]}
    assert faces[:3] == [COLOURS[0]] * 3
    assert COLOURS[0] not in faces[3:]


@pytest.mark.parametrize(
    ("rows", "said"),
    [([0, 1, 2, 3, 4, 5], "mean over 1 to 3 seeds"), ([0, 2, 4], "mean over 3 seeds"), ([0, 1, 5], "One fit each")],
)
def test_the_caption_says_over_how_many_seeds(rows: list[int], said: str) -> None:
    assert said in written(measure_bars(FRAME.iloc[rows], ["rate"]))


def test_names_slant_where_they_would_touch() -> None:
    names = [f"max-pi(an-encoder-{n})" for n in range(9)]
    (axes,) = measure_bars(pd.DataFrame({"encoder": names, "rate": 0.5}), ["rate"]).axes
    assert all(label.get_rotation() == 30 for label in axes.get_xticklabels())
    (axes,) = measure_bars(FRAME, ["rate"]).axes
    assert all(label.get_rotation() == 0 for label in axes.get_xticklabels())


def test_it_is_drawn_alike_again(tmp_path: Path) -> None:
    for run in ("one", "two"):
        save_figure(measure_bars(FRAME, ["rate", "rate_held_out"]), tmp_path / run, "rates")
    for kind in ("png", "svg"):
        assert (tmp_path / "one" / f"rates.{kind}").read_bytes() == (tmp_path / "two" / f"rates.{kind}").read_bytes()


@pytest.mark.parametrize(
    ("frame", "said"),
    [
        (FRAME, "no column 'rates'; did you mean 'rate'"),
        (FRAME.rename(columns={"encoder": "name"}), "no column 'encoder'"),
    ],
    ids=["measure", "encoder"],
)
def test_a_column_that_is_not_there_is_named(frame: pd.DataFrame, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        measure_bars(frame, ["rates"])
