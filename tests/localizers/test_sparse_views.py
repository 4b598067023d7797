from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vprbench.errors import PluginError
from vprbench_localizers.sparse_views import SparseViews
from vprbench_localizers.unit_activity import View


def view(seed: int, points: int, size: int = 7, empty: float = 0.6) -> View:
    random = np.random.default_rng(seed)
    signatures = random.standard_normal((points, size)) * (random.random((points, size)) >= empty)
    return View(signatures.astype(np.float32), random.uniform(-3, 3, points).astype(np.float32))


@settings(max_examples=40)
@given(points=st.lists(st.integers(0, 6), max_size=12), empty=st.sampled_from([0.0, 0.6, 1.0]))
def test_views_come_back_bit_by_bit(points: list[int], empty: float) -> None:
    views, memory = [view(seed, count, empty=empty) for seed, count in enumerate(points)], SparseViews()
    assert [memory.add(one) for one in views] == list(range(len(views)))
    assert (len(memory), len(memory.units.azimuths)) == (len(views), sum(points))
    for place, one in enumerate(views):
        if points[place]:
            np.testing.assert_array_equal(memory[place].signatures, one.signatures)
        np.testing.assert_array_equal(memory[place].azimuths, one.azimuths)


def test_only_what_is_not_zero_is_kept() -> None:
    memory = SparseViews()
    memory.add(View(np.eye(3, 1000, dtype=np.float32), np.zeros(3, np.float32)))
    assert len(memory._values) == 3


def test_signatures_of_another_size_are_refused() -> None:
    memory = SparseViews()
    memory.add(view(0, 2, size=7))
    memory.add(view(1, 0, size=5))
    with pytest.raises(PluginError, match="signatures of 8 values, the places stored have 7: clear"):
        memory.add(view(2, 2, size=8))


def test_signatures_of_more_columns_than_16_bits_count_are_refused() -> None:
    memory = SparseViews()
    memory.add(View(np.eye(1, 2**16, 2**16 - 1, dtype=np.float32), np.zeros(1, np.float32)))
    assert memory[0].signatures.argmax() == 2**16 - 1
    with pytest.raises(PluginError, match="signatures of 65537 values: at most 65536"):
        SparseViews().add(View(np.eye(1, 2**16 + 1, dtype=np.float32), np.zeros(1, np.float32)))
