"""Worker processes: each runs one job at a time on one thread, and may fail, hang or die without harm to others."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from queue import Queue
from time import monotonic

from pebble import ProcessExpired

from vprbench.crew import Crew, Effort
from vprbench.encoder_store import EncoderStore
from vprbench.frame_memory import FrameMemory
from vprbench.message_queue import drain, message_queue, tell
from vprbench.plugins import one_line
from vprbench.runner import Outcome, failure, run
from vprbench.sweep import Job
from vprbench.threads import one_thread

__all__ = ["Progress", "Settings", "run_all"]

# How often a worker reports, seconds: a person sees no difference, a queue does.
REPORT_EVERY = 0.1


@dataclass(frozen=True)
class Settings:
    """How jobs are run, none of which changes a result.

    Attributes:
        workers: processes at work at once.
        timeout: seconds that a job may take, None for any.
        data: the data root, None for the default.
        routes_file: a TOML with the user's own routes.
        store: of fitted encoders; None keeps none.
    """

    workers: int = 1
    timeout: float | None = None
    data: Path | None = None
    routes_file: Path | None = None
    store: EncoderStore | None = None


@dataclass(frozen=True)
class Progress:
    """How far a job has come in its present stage, and what to say of it."""

    job: int
    stage: str
    done: int
    total: int
    note: str = ""


def run_all(todo: Sequence[Job], effort: Effort, settings: Settings) -> Iterator[Progress | Outcome]:
    """Run jobs, which take so much effort; yields their progress, and each outcome as soon as it is known."""
    message: Progress | Outcome
    context = multiprocessing.get_context("spawn")
    with message_queue(context) as messages:
        work = partial(_work, settings=settings, messages=messages)
        unanswered = {cell: job for job in todo for cell in job.cells}
        lost = False
        with Crew(todo, work, effort, settings.workers, settings.timeout, context) as crew:
            crew.begin()
            while crew.is_busy:
                ended = crew.ended(within=REPORT_EVERY)
                for message in drain(messages):
                    if isinstance(message, Outcome):
                        del unanswered[message.cell]
                    yield message
                for job, future in ended:
                    lost = lost or isinstance(future.exception(), (TimeoutError, ProcessExpired))
                    for cell in job.cells:
                        if unanswered.pop(cell, None) is not None:
                            yield failure(job, cell, _fault(future, settings))
            if lost:
                crew.assemble()


def _work(job: Job, number: int, settings: Settings, messages: Queue[bytes]) -> None:
    """Run one job in a worker, on one thread: threads of several processes slow each other down."""
    last = -REPORT_EVERY

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        nonlocal last
        if done in (0, total) or monotonic() - last >= REPORT_EVERY:
            last = monotonic()
            tell(messages, Progress(number, stage, done, total, note))

    with one_thread():
        for outcome in run(job, settings.data, settings.routes_file, report, settings.store, _memory()):
            tell(messages, outcome)


@cache
def _memory() -> FrameMemory:
    """The frames that this process keeps for its next jobs."""
    return FrameMemory()


def _fault(future: Future[None], settings: Settings) -> str:
    """Why a job ended without answering all its cells."""
    error = future.exception()
    if isinstance(error, TimeoutError):
        return f"timed out: the job took longer than {settings.timeout:g} s; allow more with --timeout"
    if isinstance(error, ProcessExpired):
        return f"the worker process died: {one_line(error)}"
    return one_line(error) if error else "the job ended without an answer"
