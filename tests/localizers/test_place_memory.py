from __future__ import annotations

import numpy as np

from vprbench_localizers.place_memory import PlaceMemory


def test_places_keep_their_order_and_values_while_the_memory_grows() -> None:
    memory = PlaceMemory()
    assert memory.planes.shape == (0, 9, 1056)
    indices = [memory.add(np.full((9, 1056), value, np.float32)) for value in range(40)]
    assert indices == list(range(40))
    assert len(memory) == 40
    assert memory.planes.flags.c_contiguous
    np.testing.assert_array_equal(memory.planes[:, 3, 5], np.arange(40))


def test_adding_seldom_copies_what_is_stored() -> None:
    memory, planes = PlaceMemory(), np.zeros((9, 1056), np.float32)
    arrays = set()
    for _ in range(200):
        memory.add(planes)
        arrays.add(memory.planes.ctypes.data)
    assert len(arrays) <= 6
