"""The weight of an object, against what is known to be in it."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numba import njit

from vprbench.scale.held import held_bytes

MEGABYTE = 1_000_000


class Holder:
    def __init__(self, *things: object) -> None:
        self.things = things


def megabytes(thing: object, *without: object) -> float:
    return round(held_bytes(thing, without) / MEGABYTE, 2)


def test_arrays_weigh_what_they_hold_wherever_they_are() -> None:
    array = np.zeros(3 * MEGABYTE, np.uint8)
    assert megabytes(array) == 3
    assert megabytes(Holder([array], {"again": array})) == 3
    assert megabytes(Holder(array, np.ones(MEGABYTE, np.uint8))) == 4
    assert megabytes(partial(Holder, array)) == 3


def test_a_view_holds_all_that_it_is_a_view_of_once() -> None:
    array = np.zeros(3 * MEGABYTE, np.uint8)
    assert megabytes(Holder(array[:5], array[1:].reshape(-1, 1)[:2])) == 3


def test_values_that_are_not_numpy_s_own_weigh_the_same() -> None:
    made_by_numba: Any = njit(lambda count: np.zeros(count, np.uint8))
    array = made_by_numba(3 * MEGABYTE)
    assert megabytes([array, array[5:], array.reshape(-1, 1)]) == 3
    assert megabytes(np.frombuffer(bytearray(MEGABYTE), np.uint8)) == 1


def test_what_is_left_out_and_what_all_share_weigh_nothing() -> None:
    encoder, array = Holder(np.zeros(5 * MEGABYTE, np.uint8)), np.zeros(MEGABYTE, np.uint8)
    assert megabytes(Holder(encoder, array)) == 6
    assert megabytes(Holder(encoder, array), encoder) == 1
    assert held_bytes(Holder(np, np.sum, Holder, test_arrays_weigh_what_they_hold_wherever_they_are)) < 1000


def test_what_refers_to_itself_is_weighed_once() -> None:
    ring: list[object] = [np.zeros(2 * MEGABYTE, np.uint8)]
    ring.append(ring)
    assert megabytes(ring) == 2
