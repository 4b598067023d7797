"""The map of a route: what is drawn where."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.collections import PathCollection

from vprbench.data_checks.overlap import overlap
from vprbench.figures.revisit_map import revisit_map
from vprbench.route import Route


def test_both_drives_are_drawn_at_scale_and_far_frames_are_tied_to_the_nearest(toy_route: Route) -> None:
    aside = np.zeros((30, 2))
    aside[:4, 0] = 6.0
    route = replace(toy_route, test=replace(toy_route.test, positions=toy_route.test.positions + aside))
    beside = overlap(route)
    (axes,) = revisit_map(route, beside).axes
    near, far = (np.asarray(marks.get_offsets()) for marks in axes.collections if isinstance(marks, PathCollection))
    assert (len(near), len(far)) == (26, 4)
    lines = [np.asarray(line.get_xydata()) for line in axes.lines]
    ties = [line for line in lines if len(line) == 2]
    lengths = [float(np.linalg.norm(np.diff(tie, axis=0))) for tie in ties]
    np.testing.assert_allclose(lengths, beside.distance[:4])
    (learn,) = (line for line in lines if len(line) == 41)
    np.testing.assert_allclose(np.linalg.norm(np.diff(learn, axis=0), axis=1), 1.0)
    assert axes.get_aspect() == 1.0


def test_a_route_without_far_frames_names_none(toy_route: Route) -> None:
    figure = revisit_map(toy_route, overlap(toy_route))
    names = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert names == ["learn drive", "test frame"]
