"""The queue by which worker processes tell their parent what they find, held by a process of its own.

That process imports this module alone and holds bytes, not what they mean, so that it starts at once.
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.context import SpawnContext
from multiprocessing.managers import SyncManager
from queue import Empty, Queue
from threading import Thread
from time import sleep
from typing import Any

__all__ = ["drain", "message_queue", "tell"]


@contextmanager
def message_queue(context: SpawnContext) -> Iterator[Queue[bytes]]:
    """A queue that, unlike a pipe, survives a worker killed in the middle of a message."""
    manager = SyncManager(ctx=context)
    manager.start(_end_with, (os.getpid(),))
    with manager:
        yield manager.Queue()


def tell(messages: Queue[bytes], message: object) -> None:
    """Say something that can be pickled."""
    messages.put(pickle.dumps(message))


def drain(messages: Queue[bytes]) -> Iterator[Any]:
    """Everything that has been said so far."""
    while True:
        try:
            yield pickle.loads(messages.get_nowait())
        except Empty:
            return


def _end_with(parent: int) -> None:
    """Watch the parent, and end when it is gone, since a killed one tells nobody."""

    def watch() -> None:
        while os.getppid() == parent:
            sleep(1.0)
        os._exit(1)

    Thread(target=watch, daemon=True).start()
