"""The encoder that can be told what to answer is the other one in everything else."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from vprbench.frequency.rehearsal import Rehearsal
from vprbench.frequency.subjects import Agent
from vprbench.types import Landmarks

FRAME = np.full((188, 642), 7, np.uint8)
ROWS = np.array([[7.0], [8.0]], np.float32)


@pytest.fixture
def rehearsal(ledger: Callable[..., Agent]) -> Any:  # noqa: ANN401
    return ledger(pairs=True).rehearsal


def test_it_passes_everything_on(rehearsal: Any) -> None:  # noqa: ANN401
    np.testing.assert_array_equal(rehearsal.encode(FRAME).signatures, [[7]])
    np.testing.assert_array_equal(rehearsal.match(ROWS, ROWS), np.eye(2))
    np.testing.assert_array_equal(rehearsal.match_pairs(ROWS, ROWS, np.array([0, 1]), np.array([0, 0])), [1, 0])
    same = np.array([0, 1])
    assert rehearsal.match_at_most(ROWS, ROWS, same, same).tolist() == [1.5, 1.5]
    assert rehearsal.nickname == "tick"
    with pytest.raises(AttributeError, match="surname"):
        _ = rehearsal.surname


def test_it_recalls_only_while_it_is_told_to(rehearsal: Any) -> None:  # noqa: ANN401
    recalled = Landmarks(ROWS, np.zeros((2, 2), np.float32))
    with rehearsal.recalling(recalled):
        assert rehearsal.encode(FRAME) is recalled
        np.testing.assert_array_equal(rehearsal.match(ROWS, ROWS), np.eye(2))
    with rehearsal.recalling(recalled, blank=True):
        np.testing.assert_array_equal(rehearsal.match(ROWS, ROWS[:1]), np.zeros((2, 1)))
        assert rehearsal.match_pairs(ROWS, ROWS, np.array([0]), np.array([0])).tolist() == [0]
        assert rehearsal.match_at_most(ROWS, ROWS, np.array([0]), np.array([0])).tolist() == [0]
    assert rehearsal.encode(FRAME) is not recalled
    np.testing.assert_array_equal(rehearsal.match(ROWS, ROWS), np.eye(2))


def test_it_compares_pairs_only_if_the_other_does(ledger: Callable[..., Agent], rehearsal: Rehearsal) -> None:
    for name in ("match_pairs", "match_at_most"):
        assert hasattr(rehearsal, name)
        assert not hasattr(ledger().rehearsal, name)


def test_localizers_that_are_copied_go_on_looking_through_it(rehearsal: Rehearsal) -> None:
    assert deepcopy({"encoder": rehearsal})["encoder"] is rehearsal
