"""Bars of scores against means and deviations by hand."""

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
from vprbench.figures.bars import score_bars
from vprbench.figures.files import save_figure

# zeta is seeded, $a$ is not; _b was measured at one distance only, which failed to give a score on the second route.
ROWS = pd.DataFrame(
    [
        ("far", "zeta", 5.0, 0, 0.2),
        ("far", "zeta", 5.0, 1, 0.4),
        ("far", "$a$", 5.0, 0, 0.7),
        ("far", "zeta", 2.0, 0, 0.6),
        ("far", "zeta", 2.0, 1, 0.8),
        ("far", "$a$", 2.0, 0, 0.9),
        ("near", "_b", 2.0, 0, np.nan),
        ("far", "_b", 2.0, 0, 1.0),
    ],
    columns=["route", "agent", "sampling_distance_m", "seed", "auc"],
)


def bars(axes: Axes) -> np.ndarray:
    """Centre and height of each bar, from left to right."""
    patches = [patch for container in axes.containers if isinstance(container, BarContainer) for patch in container]
    return np.array(sorted((patch.get_x() + patch.get_width() / 2, patch.get_height()) for patch in patches))


def whiskers(axes: Axes) -> np.ndarray:
    """Place and half length of each whisker, from left to right."""
    lines = [container.lines[2][0] for container in axes.containers if isinstance(container, ErrorbarContainer)]
    ends = [np.asarray(line.get_segments()[0]) for line in lines]
    return np.array(sorted((segment[0, 0], (segment[1, 1] - segment[0, 1]) / 2) for segment in ends))


def names(axes: Axes) -> list[str]:
    return [label.get_text() for label in axes.get_xticklabels()]


def written(figure: Figure) -> str:
    return " ".join(" ".join(text.get_text() for text in figure.texts).split())


def test_one_bar_an_agent_is_the_mean_over_its_cells_in_the_order_of_the_rows() -> None:
    (axes,) = score_bars(ROWS).axes
    assert names(axes) == ["zeta", r"\$a\$", " _b"]
    np.testing.assert_allclose(bars(axes), [(0, 50), (1, 80), (2, 100)])
    assert axes.get_ylim()[0] == 0
    assert [text.get_text() for text in axes.texts] == ["50.0", "80.0", "100.0"]


def test_whiskers_are_the_standard_deviation_over_cells() -> None:
    (axes,) = score_bars(ROWS).axes
    # Of 20, 40, 60, 80: squares 900 + 100 + 100 + 900 over 3. Of 70 and 90: 20 over the root of 2. Of one: none.
    np.testing.assert_allclose(whiskers(axes), [(0, np.sqrt(2000 / 3)), (1, np.sqrt(200))])


def test_dots_are_the_cells_and_stand_within_their_bar() -> None:
    (axes,) = score_bars(ROWS).axes
    lines = [line for line in axes.lines if line.get_marker() == "o"]
    assert [sorted(np.asarray(line.get_ydata())) for line in lines] == [
        pytest.approx([20, 40, 60, 80]),
        pytest.approx([70, 90]),
    ]
    assert all(np.abs(np.asarray(line.get_xdata()) - place).max() < 0.36 for place, line in enumerate(lines))


def test_groups_of_distances_rise_and_a_missing_agent_leaves_a_gap() -> None:
    (axes,) = score_bars(ROWS, by="sampling_distance_m").axes
    assert names(axes) == ["2", "5"]
    width = 0.86 / 3
    expected = [(-width, 70), (0, 90), (width, 100), (1 - width, 30), (1, 70)]
    np.testing.assert_allclose(bars(axes), expected, atol=1e-9)
    (legend,) = axes.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["zeta", r"\$a\$", " _b"]


def test_distances_are_in_the_unit_of_the_rows() -> None:
    rows = ROWS.assign(unit="frames")
    assert score_bars(ROWS, by="sampling_distance_m").axes[0].get_xlabel() == "sampling distance, m"
    assert score_bars(rows, by="sampling_distance_m").axes[0].get_xlabel() == "sampling distance, frames"


def test_groups_of_routes_keep_the_order_of_the_rows() -> None:
    (axes,) = score_bars(ROWS, by="route").axes
    assert names(axes) == ["far", "near"]
    # The only cell of "near" has no score.
    assert len(bars(axes)) == 3


def test_groups_and_the_axis_can_be_named() -> None:
    (axes,) = score_bars(ROWS, by="route", names={"near": "2 m"}, axis="offset", title="$t$").axes
    assert names(axes) == ["far", "2 m"]
    assert axes.get_xlabel() == "offset"
    assert axes.get_title(loc="left") == r"\$t\$"
    assert {label.get_rotation() for label in axes.get_xticklabels()} == {0}
    many = pd.concat([ROWS.assign(route=f"a road with a name {turn}") for turn in range(9)])
    assert {label.get_rotation() for label in score_bars(many, by="route").axes[0].get_xticklabels()} == {25}


def test_what_the_paper_states_stands_beside_the_bars_of_those_agents() -> None:
    figure = score_bars(ROWS, paper={"zeta": 0.85, "absent": 0.5})
    diamonds = [line for line in figure.axes[0].lines if line.get_marker() == "D"]
    assert [np.asarray(line.get_xydata()).tolist() for line in diamonds] == [[[0, 85]]]
    assert "Diamonds" in written(figure)
    assert "Diamonds" not in written(score_bars(ROWS, paper={"absent": 0.5}))


def test_the_caption_says_over_what_the_means_are() -> None:
    assert "means over 1 to 4 cells (2 routes, 2 distances, 2 seeds;" in written(score_bars(ROWS))
    assert "means over 1 to 2 cells (2 routes, 2 seeds;" in written(score_bars(ROWS, by="sampling_distance_m"))
    assert "recall over the correct top-1s." in written(score_bars(ROWS))
    assert "nothing is random" not in written(score_bars(ROWS[ROWS["agent"] == "zeta"]))
    by_metric_rule = score_bars(ROWS.rename(columns={"auc": "auc_all_metric"}), "auc_all_metric")
    assert "recall over all queries, by the metric rule." in written(by_metric_rule)


def test_colours_can_be_those_of_a_whole_report() -> None:
    colours = {"zeta": "#102030", "$a$": "#405060", "_b": "#708090"}
    (axes,) = score_bars(ROWS, colours=colours).axes
    assert [to_hex(patch.get_edgecolor()) for patch in axes.patches] == list(colours.values())


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (ROWS.iloc[:0], "no finished cell"),
        (ROWS.rename(columns={"auc": "auk"}), "no column 'auc'; did you mean 'auk'"),
        (ROWS.drop(columns="route"), "no column 'route'"),
    ],
    ids=["empty", "metric", "group"],
)
def test_what_cannot_be_drawn_is_told(rows: pd.DataFrame, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        score_bars(rows, by="route")


def test_it_is_drawn_alike_again(tmp_path: Path) -> None:
    for run in ("one", "two"):
        save_figure(score_bars(ROWS, by="route"), tmp_path / run, "bars")
    for kind in ("png", "svg"):
        assert (tmp_path / "one" / f"bars.{kind}").read_bytes() == (tmp_path / "two" / f"bars.{kind}").read_bytes()
