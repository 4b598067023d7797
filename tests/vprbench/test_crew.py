"""Which worker does which job, and what becomes of the others when one fails."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from importlib import import_module
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pebble import ProcessExpired

from vprbench.crew import Crew, Effort, Work, next_job
from vprbench.sweep import Job

# Jobs that do as their route says; processes that are started anew can import it.
WORK = """
import os, time
from pathlib import Path

def work(job, number):
    Path(__file__).with_name(str(number)).write_text(str(os.getpid()))
    if job.route == "dies":
        os._exit(7)
    if job.route == "hangs":
        time.sleep(600)
"""


def jobs(routes: Iterable[str]) -> dict[int, Job]:
    return {number: Job(route, "agent", number, "cohog", ()) for number, route in enumerate(routes)}


def alike(job: Job) -> float:
    return 1


def shared_out(routes: str, workers: int, effort: Effort = alike) -> list[str]:
    """The routes that each worker plays, one after the other, where a job takes as long as is expected of it."""
    waiting, played, busy = jobs(routes), [""] * workers, [0.0] * workers
    while waiting:
        worker = busy.index(min(busy))
        others = [played[other][-1:] for other in range(workers) if other != worker]
        job = waiting.pop(next_job(waiting, played[worker][-1:], others, effort))
        played[worker] += job.route
        busy[worker] += effort(job)
    return played


def test_two_workers_take_a_route_each_and_share_the_last() -> None:
    assert shared_out("aabbcc", workers=2) == ["aac", "bbc"]


def test_a_worker_alone_plays_one_route_after_the_other_as_they_come() -> None:
    assert shared_out("bbaacc", workers=1) == ["bbaacc"]


def test_no_worker_waits_for_a_route_that_another_is_on() -> None:
    assert shared_out("aaaaaa", workers=3) == ["aa", "aa", "aa"]


def test_of_its_route_a_worker_does_the_first_job() -> None:
    assert next_job(jobs("abab"), "b", ["a"], alike) == 1


def test_both_workers_begin_on_a_route_that_outweighs_the_rest() -> None:
    assert shared_out("aaabbbccc", 2, lambda job: {"a": 9, "b": 3, "c": 1}[job.route]) == ["aacc", "abbbc"]


def test_a_route_that_more_than_one_is_on_waits_for_one_with_less_to_do() -> None:
    assert next_job(jobs("aab"), "c", ["a", "a"], alike) == 2
    assert next_job(jobs("aab"), "c", ["a"], alike) == 0


@given(routes=st.text("abcd", min_size=1, max_size=20), workers=st.integers(1, 5))
def test_every_job_is_done_once(routes: str, workers: int) -> None:
    assert sorted("".join(shared_out(routes, workers))) == sorted(routes)


@pytest.fixture
def work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Work:
    """What each worker does: note its process in a file named by the job's number, then as the job's route says."""
    (tmp_path / "crew_work.py").write_text(WORK)
    monkeypatch.syspath_prepend(str(tmp_path))
    done: Work = import_module("crew_work").work
    return done


@pytest.fixture
def hire(work: Work) -> Callable[..., Crew]:
    """A crew for jobs of these routes."""

    def hired(*routes: str, workers: int, timeout: float | None = None) -> Crew:
        todo = list(jobs(routes).values())
        # In the order given, whatever the routes.
        return Crew(todo, work, lambda job: 10.0**-job.seed, workers, timeout, multiprocessing.get_context("spawn"))

    return hired


def answers(crew: Crew) -> dict[int, Future[None]]:
    """How each job ended, by its number, which is its seed here."""
    found = {}
    crew.begin()
    while crew.is_busy:
        found.update({job.seed: future for job, future in crew.ended(within=1.0)})
    crew.assemble()
    return found


def test_one_that_dies_or_hangs_takes_no_other_down(hire: Callable[..., Crew], tmp_path: Path) -> None:
    with hire("dies", "hangs", "good", "good", workers=1, timeout=5.0) as crew:
        ended = answers(crew)
    assert isinstance(ended[0].exception(), ProcessExpired)
    assert isinstance(ended[1].exception(), TimeoutError)
    assert [ended[number].exception() for number in (2, 3)] == [None, None]
    played = [(tmp_path / str(number)).read_text() for number in range(4)]
    assert len(set(played[:3])) == 3
    assert played[3] == played[2]


def test_a_crew_that_is_stopped_leaves_no_process_behind(hire: Callable[..., Crew], tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), hire("hangs", "hangs", "hangs", workers=2) as crew:
        crew.begin()
        while not all((tmp_path / name).exists() and (tmp_path / name).read_text() for name in "01"):
            time.sleep(0.05)
        raise KeyboardInterrupt
    for name in "01":
        with pytest.raises(ProcessLookupError):
            os.kill(int((tmp_path / name).read_text()), 0)
    assert not (tmp_path / "2").exists()
