from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text

from vprbench.errors import ConfigError
from vprbench.figures.scale import scale_curves

TABLE = pd.DataFrame(
    {
        "agent": ["fast", "fast", "slow", "slow"],
        "places": [1000, 100, 100, 1000],
        "query_ms": [2.0, 1.0, 50.0, np.nan],
        "query_ms_q1": [1.5, 0.5, 40.0, np.nan],
        "query_ms_q3": [3.0, 1.5, 60.0, np.nan],
        "queries": [15, 15, 15, np.nan],
        "stopped": ["", "", "", "would take 500 s a query, above 5 s"],
    }
)


def test_curves_go_through_what_was_measured_and_a_cross_ends_what_was_stopped() -> None:
    figure = scale_curves(TABLE)
    axes = figure.axes[0]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    lines = [(line.get_marker(), np.asarray(line.get_xydata()).tolist()) for line in axes.lines]
    assert lines == [("o", [[100, 1], [1000, 2]]), ("o", [[100, 50]]), ("x", [[100, 50]])]
    said = " ".join(text.get_text() for text in figure.findobj(Text)).replace("\n", " ")
    assert "Crosses: more places would have passed a limit" in said


def test_what_is_no_such_table_is_refused() -> None:
    with pytest.raises(ConfigError, match="no column 'stopped'"):
        scale_curves(TABLE.drop(columns="stopped"))
    with pytest.raises(ConfigError, match="no rows that were timed"):
        scale_curves(TABLE[3:])
