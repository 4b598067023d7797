"""The grid of a sweep: its cells, its jobs and its filter."""

from __future__ import annotations

import pytest

from vprbench.errors import ConfigError
from vprbench.sweep import Cell, Sweep, builtin_sweeps, jobs, load_sweep, matching


def test_every_built_in_sweep_is_sound() -> None:
    for name in builtin_sweeps():
        assert list(load_sweep(name)[1].cells())


def test_the_grid_is_the_product_with_seeds_only_where_they_matter() -> None:
    sweep = Sweep(routes=["A", "B"], sampling_distances=[2, 3], seeds=[0, 1], agents={"x": {"localizer": "cohog"}})
    cells = list(sweep.cells())
    assert [cell.id for cell in cells] == ["A/2m/x/s0", "A/3m/x/s0", "B/2m/x/s0", "B/3m/x/s0"]
    assert [len(job.cells) for job in jobs(sweep, cells)] == [2, 2]


def test_a_filter_matches_anywhere_in_the_id() -> None:
    cells = [Cell("K", "a", 2.0, 0), Cell("K", "b", 2.0, 0), Cell("K", "b", 5.0, 0)]
    assert matching(cells, "/b/") == cells[1:]
    assert matching(cells, "2m*b") == [cells[1]]
    with pytest.raises(ConfigError, match="matches no cell"):
        matching(cells, "9m")


def test_a_filter_takes_brackets_as_they_are() -> None:
    cells = [Cell("K", "a[size=3]", 2.0, 0), Cell("K", "a", 2.0, 0)]
    assert matching(cells, "a[size=3]") == cells[:1]
