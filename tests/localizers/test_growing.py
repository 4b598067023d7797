from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench_localizers.growing import Growing


@given(
    counts=st.lists(st.integers(0, 40), max_size=20),
    shape=st.sampled_from([(), (3,), (2, 5)]),
    dtype=st.sampled_from(["float32", "uint8", "int64"]),
)
def test_rows_keep_their_order_and_values_while_the_array_grows(
    counts: list[int], shape: tuple[int, ...], dtype: str
) -> None:
    growing, parts = Growing(dtype, *shape), [np.zeros((0, *shape), dtype)]
    for count in counts:
        random = np.random.default_rng(count)
        parts.append(random.integers(0, 99, (count, *shape)).astype(dtype))
        growing.extend(parts[-1])
    np.testing.assert_array_equal(growing.rows, np.concatenate(parts))
    assert growing.rows.dtype == dtype
    assert len(growing) == sum(counts)
    assert growing.rows.flags.c_contiguous


@pytest.mark.parametrize("shape", [(), (9, 1056)])
def test_it_begins_with_a_line_of_the_cache_and_seldom_moves(shape: tuple[int, ...]) -> None:
    growing, addresses = Growing(np.float32, *shape), set()
    for _ in range(200):
        growing.extend(np.zeros((1, *shape), np.float32))
        addresses.add(growing.rows.ctypes.data)
    assert len(addresses) <= 6
    assert not any(address % 64 for address in addresses)
