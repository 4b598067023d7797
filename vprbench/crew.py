"""The worker processes of a sweep, and which of them does which job: one that knows the route, where there is one."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from multiprocessing.context import SpawnContext
from types import TracebackType
from typing import Self

from pebble import ProcessPool

from vprbench.sweep import Job

__all__ = ["Crew", "Effort", "Work", "next_job"]

# How long processes may take to start, seconds, before nobody waits for them any more.
ASSEMBLY = 30.0

# Runs a job, given with its number, in a process; what it finds out it tells by other ways.
Work = Callable[[Job, int], None]

# How much there is to do in a job, in any unit.
Effort = Callable[[Job], float]


def next_job(waiting: Mapping[int, Job], route: str, others: Sequence[str], effort: Effort) -> int:
    """The number of the job that a worker does next.

    The first of its own route, whose frames it has; else of the route on which most would be left to each worker, were
    it to join. Equally many routes and workers so get one each, but several begin on a route that outweighs the rest.

    Args:
        waiting: jobs by their number, at least one.
        route: that the worker is on.
        others: the routes that the other workers are on, one each.
        effort: of a job.
    """
    left = defaultdict[str, float](float)
    for job in waiting.values():
        left[job.route] += effort(job)

    def appeal(number: int) -> tuple[bool, float]:
        there = waiting[number].route
        return there == route, left[there] / (1 + others.count(there))

    return max(waiting, key=appeal)


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
        effort: of each.
        workers: processes, though never more than there are jobs.
        timeout: seconds that a job may take, None for any.
        context: of the processes.
    """

    def __init__(
        self,
        todo: Sequence[Job],
        work: Work,
        effort: Effort,
        workers: int,
        timeout: float | None,
        context: SpawnContext,
    ) -> None:
        self._work, self._effort, self._timeout = work, effort, timeout
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
        others = [other.route for other in self._workers if other is not worker]
        number = next_job(self._waiting, worker.route, others, self._effort)
        job = self._waiting.pop(number)
        worker.route = job.route
        self._at_work[worker.pool.schedule(self._work, args=[job, number], timeout=self._timeout)] = worker, job


def _do_nothing() -> None:
    """What a worker can do as soon as it has started."""
