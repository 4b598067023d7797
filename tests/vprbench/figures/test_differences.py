from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from vprbench.errors import ConfigError
from vprbench.figures.differences import paired_differences
from vprbench.figures.files import save_figure
from vprbench.figures.style import COLOURS, GREY

# Not in order; the second is too short a drive to have an interval, and the third holds 0.
FRAME = pd.DataFrame(
    {
        "metric": "auc_all_metric",
        "agent": ["worse", "short", "same", "better"],
        "reference": "LPMP",
        "difference": [-0.10, 0.01, 0.02, 0.2],
        "low": [-0.15, np.nan, -0.03, 0.1],
        "high": [-0.05, np.nan, 0.06, 0.25],
        "cells": [3, 3, 3, 2],
        "queries": [80, 80, 80, 80],
    }
)


def lines(figure: Figure, points: int) -> list[Line2D]:
    """The drawn dots (of one point) or intervals (of two), but for the line of no difference."""
    drawn = [line for line in figure.axes[0].lines if len(line.get_ydata()) == points]  # type: ignore[arg-type]
    return [line for line in drawn if np.unique(line.get_xdata()).tolist() != [0.0]]


def heights(figure: Figure) -> list[float]:
    return [float(np.asarray(line.get_ydata())[0]) for line in lines(figure, 1)]


def test_dots_and_intervals_stand_where_the_frame_says_the_largest_on_top() -> None:
    figure = paired_differences(FRAME)
    axes = figure.axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["better", "same", "short", "worse"]
    assert heights(figure) == [0, 1, 2, 3]
    assert axes.get_ylim()[0] > axes.get_ylim()[1]
    dots = [float(np.asarray(line.get_xdata())[0]) for line in lines(figure, 1)]
    assert dots == pytest.approx([20.0, 2.0, 1.0, -10.0])
    spans = [np.asarray(line.get_xdata()).tolist() for line in lines(figure, 2)]
    assert spans == [pytest.approx(span) for span in ([10.0, 25.0], [-3.0, 6.0], [-15.0, -5.0])]


def test_only_shown_differences_stand_out() -> None:
    figure = paired_differences(FRAME)
    colours = [to_hex(line.get_color()).upper() for line in lines(figure, 1)]
    assert colours == [COLOURS[0].upper(), GREY.upper(), GREY.upper(), COLOURS[0].upper()]
    faces = [to_hex(line.get_markerfacecolor()) for line in lines(figure, 1)]
    assert faces[1] == faces[2] == "#ffffff"
    assert "#ffffff" not in (faces[0], faces[3])


def test_the_words_say_what_is_compared_with_what() -> None:
    axes = paired_differences(FRAME).axes[0]
    assert axes.get_title(loc="left") == "PR-AUC, recall over all queries"
    assert axes.get_xlabel() == "difference from LPMP, percentage points"
    mixed = FRAME.assign(reference=["LPMP", "LPMP", "CoHOG", "CoHOG"])
    figure = paired_differences(mixed)
    assert figure.axes[0].get_yticklabels()[0].get_text() == "better \N{MINUS SIGN} CoHOG"
    caption = " ".join(figure.get_supxlabel().split())
    assert "2 to 3 cells (route, distance) with 80 queries, by the metric rule" in caption


def test_it_is_saved_to_equal_bytes(tmp_path: Path) -> None:
    one, again = (save_figure(paired_differences(FRAME), tmp_path / name, "d") for name in ("one", "again"))
    assert one.svg.read_bytes() == again.svg.read_bytes()
    assert one.png.read_bytes() == again.png.read_bytes()


@pytest.mark.parametrize(
    ("frame", "said"),
    [
        (FRAME.drop(columns="low"), "no column 'low'"),
        (FRAME.iloc[:0], "no rows"),
        (FRAME.assign(metric=["auc", "auc", "auc", "accuracy"]), "several metrics"),
    ],
)
def test_what_is_no_comparison_is_refused(frame: pd.DataFrame, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        paired_differences(frame)
