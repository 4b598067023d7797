from __future__ import annotations

import numpy as np

from vprbench_localizers.place_memory import PlaceMemory


def test_places_keep_their_order_and_values_while_the_memory_grows() -> None:
    memory = PlaceMemory()
    assert memory.planes.shape == (0, 32, 288)
    indices = [memory.add(np.full((32, 288), value, np.float32)) for value in range(40)]
    assert indices == list(range(40))
    assert len(memory) == 40
    assert memory.planes.flags.c_contiguous
    assert memory.planes.ctypes.data % 64 == 0
    np.testing.assert_allclose(memory.outlines[1:], 128**-0.5, rtol=1e-5)
    np.testing.assert_array_equal(memory.planes[:, 3, 5], np.arange(40))


def test_adding_seldom_copies_what_is_stored() -> None:
    memory, planes = PlaceMemory(), np.zeros((32, 288), np.float32)
    arrays = set()
    for _ in range(200):
        memory.add(planes)
        arrays.add(memory.planes.ctypes.data)
    assert len(arrays) <= 6


def test_a_memory_is_made_of_places() -> None:
    memory = PlaceMemory.of([np.full((32, 288), value, np.float32) for value in range(3)])
    assert memory.add(np.full((32, 288), 3, np.float32)) == 3
    np.testing.assert_array_equal(memory.planes[:, 0, 0], range(4))
    assert len(PlaceMemory.of([])) == 0
