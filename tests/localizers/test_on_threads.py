from __future__ import annotations

import threading

import pytest

from vprbench_localizers.on_threads import on_threads


def test_parts_are_worked_on_at_the_same_time_and_kept_in_order() -> None:
    # Each waits for the other two: one after another, they would never be done.
    met = threading.Barrier(3, timeout=30)

    def work(part: int) -> int:
        met.wait()
        return part * part

    assert on_threads(work, [3, 1, 2]) == [9, 1, 4]


@pytest.mark.parametrize("parts", [[], [7]])
def test_a_single_part_stays_on_the_calling_thread(parts: list[int]) -> None:
    assert on_threads(lambda _: threading.get_ident(), parts) == [threading.get_ident()] * len(parts)


def test_a_fault_on_a_thread_reaches_the_caller() -> None:
    with pytest.raises(ZeroDivisionError):
        on_threads(lambda part: 1 // part, [1, 0])
