"""What is said to the queue of a sweep arrives whole, in order and once."""

from __future__ import annotations

import multiprocessing
import sys
from multiprocessing.context import SpawnContext
from types import ModuleType

import numpy as np
import pytest

from vprbench.message_queue import drain, message_queue, tell


@pytest.fixture
def context() -> SpawnContext:
    return multiprocessing.get_context("spawn")


def test_what_was_said_arrives_in_order_and_once(context: SpawnContext) -> None:
    with message_queue(context) as messages:
        assert list(drain(messages)) == []
        for message in ("first", {"second": 2}, np.arange(3)):
            tell(messages, message)
        first, second, third = drain(messages)
        assert (first, second, third.tolist()) == ("first", {"second": 2}, [0, 1, 2])
        assert list(drain(messages)) == []


def test_the_process_that_holds_the_messages_need_not_know_what_they_mean(
    context: SpawnContext, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "known_here_only", module := ModuleType("known_here_only"))
    exec("class Finding(int): pass", module.__dict__)
    with message_queue(context) as messages:
        tell(messages, module.Finding(7))
        assert list(drain(messages)) == [7]
