"""The worker processes of a sweep, and which of them does which job: one that knows the route, if none stays idle."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from multiprocessing.context import SpawnContext
from types import TracebackType
from typing import Self

from pebble import ProcessPool

from vprbench.sweep import Job

__all__ = ["Crew", "Work", "next_job"]

# How long processes may take to start, seconds, before nobody waits for them any more.
ASSEMBLY = 30.0

# Runs a job, given with its number, in a process; what it finds out it tells by other ways.
Work = Callable[[Job, int], None]


def next_job(waiting: Mapping[int, Job], route: str, others: Set[str]) -> int:
    """The number of the job to do next: the first of the worker's own route, else of one that no other is on."""
    return min(waiting, key=lambda number: (waiting[number].route != route, waiting[number].route in others))


@dataclass
class _Worker:
    """One process, started anew when it dies, and the route that it plays or has played last."""

    pool: ProcessPool
    route: str = ""


class Crew:
    """Worker processes that share out jobs, each with a memory of the route it is on; to be used in a `with`.

    Args:
        todo: the jobs, those that should begin first first.
        work: does one of them.
        workers: processes, though never more than there are jobs.
        timeout: seconds that a job may take, None for any.
        context: of the processes.
    """

    def __init__(
        self, todo: Sequence[Job], work: Work, workers: int, timeout: float | None, context: SpawnContext
    ) -> None:
        self._work, self._timeout = work, timeout
        self._workers = [_Worker(ProcessPool(1, context=context)) for _ in range(min(workers, len(todo)))]
        self._waiting = dict(enumerate(todo))
        self._at_work: dict[Future[None], tuple[_Worker, Job]] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Wait for the processes to end, and where something failed, end them at once."""
        for worker in self._workers:
            worker.pool.close() if kind is None else worker.pool.stop()
        for worker in self._workers:
            worker.pool.join()

    def begin(self) -> None:
        """Give every worker its first job."""
        for worker in self._workers:
            self._employ(worker)

    @property
    def is_busy(self) -> bool:
        """Whether a job is at work."""
        return bool(self._at_work)

    def ended(self, within: float) -> list[tuple[Job, Future[None]]]:
        """The jobs that end within so many seconds, as soon as there is one; their workers have new ones by then."""
        done, _ = wait(self._at_work, timeout=within, return_when=FIRST_COMPLETED)
        ended = []
        for future in done:
            worker, job = self._at_work.pop(future)
            ended.append((job, future))
            self._employ(worker)
        return ended

    def assemble(self) -> None:
        """Wait until all workers have started: one that is still starting when it is to end complains of it."""
        wait([worker.pool.schedule(_do_nothing) for worker in self._workers], timeout=ASSEMBLY)

    def _employ(self, worker: _Worker) -> None:
        """Give a worker its next job, if there is one."""
        if not self._waiting:
            return
        number = next_job(self._waiting, worker.route, {other.route for other in self._workers if other is not worker})
        job = self._waiting.pop(number)
        worker.route = job.route
        self._at_work[worker.pool.schedule(self._work, args=[job, number], timeout=self._timeout)] = worker, job


def _do_nothing() -> None:
    """What a worker can do as soon as it has started."""
