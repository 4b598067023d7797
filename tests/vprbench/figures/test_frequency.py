from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.lines import Line2D

from vprbench.errors import ConfigError
from vprbench.figures.files import save_figure
from vprbench.figures.frequency import frequency_curves
from vprbench.frequency.question import PaperPoint

# LPMP takes 1 ms and 0.1 ms a place, HSD 3 ms and 0.01 ms a place: 23 and a bit.
PLACES = np.array([100, 1, 10])
TABLE = pd.concat(
    [
        pd.DataFrame({"agent": agent, "places": PLACES, "query_ms": base + slope * PLACES, "rounds": 15})
        for agent, base, slope in (("LPMP", 1.0, 0.1), ("HSD_$", 3.0, 0.01))
    ]
).assign(query_ms_q1=lambda rows: 0.9 * rows["query_ms"], query_ms_q3=lambda rows: 1.25 * rows["query_ms"])


def points(line: Line2D) -> np.ndarray:
    return np.column_stack([np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)])


def test_curves_go_through_the_measured_frequencies() -> None:
    axes = frequency_curves(TABLE).axes[0]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    lpmp, hsd = axes.lines
    for line, base, slope in ((lpmp, 1.0, 0.1), (hsd, 3.0, 0.01)):
        places, hz = points(line).T
        np.testing.assert_allclose(hz, 1000 / (base + slope * places))
        marked: list[int] = line.get_markevery()  # type: ignore[assignment]
        np.testing.assert_allclose(places[marked], [1, 10, 100])
    band = np.asarray(axes.collections[0].get_paths()[0].vertices)
    np.testing.assert_allclose([np.min(band[:, 1]), np.max(band[:, 1])], [1000 / 1.25 / 11, 1000 / 0.9 / 1.1])


def test_a_ring_stands_where_two_curves_cross() -> None:
    axes = frequency_curves(TABLE, reference="LPMP").axes[0]
    crossing = 2 / 0.09
    np.testing.assert_allclose(points(axes.lines[-1]), [[crossing, 1000 / (1 + 0.1 * crossing)]])
    assert len(axes.lines) == 3
    assert len(frequency_curves(TABLE, reference="absent").axes[0].lines) == 2


def test_the_papers_frequencies_stand_beside_their_agents() -> None:
    paper = (PaperPoint(agent="LPMP", places=100, hz=5.5), PaperPoint(agent="absent", places=100, hz=9.0))
    figure = frequency_curves(TABLE, paper=paper)
    np.testing.assert_allclose(points(figure.axes[0].lines[-1]), [[100, 5.5]])
    assert [text.get_text() for text in figure.axes[0].texts] == ["LPMP, paper"]
    assert "as the paper states them" in figure.get_supxlabel()
    assert "paper" not in frequency_curves(TABLE).get_supxlabel()


def test_it_is_drawn_whatever_agents_are_called(tmp_path: Path) -> None:
    figure = frequency_curves(TABLE, reference="LPMP")
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["LPMP", r"HSD_\$"]
    files = save_figure(figure, tmp_path, "frequency")
    assert files.png.stat().st_size > 10_000
    again = save_figure(frequency_curves(TABLE, reference="LPMP"), tmp_path / "again", "frequency")
    assert files.svg.read_bytes() == again.svg.read_bytes()


def test_another_table_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"no column 'query_ms'; give the frequency\.csv"):
        frequency_curves(TABLE.drop(columns="query_ms"))
    with pytest.raises(ConfigError, match="no rows"):
        frequency_curves(TABLE[:0])
