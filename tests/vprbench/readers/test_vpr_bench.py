"""VPR-Bench's layout, its lists of right references, and pickles that are no data."""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from vprbench.catalogue import catalogue, load_route
from vprbench.errors import DataError
from vprbench.fitted import fitted_agent
from vprbench.place_fields import record_fields
from vprbench.readers.safe_npy import read_objects
from vprbench.readers.vpr_bench import read_matches
from vprbench.runner import run
from vprbench.sweep import Cell, Job

Writer = Callable[..., None]

# Five queries, of references 0 to 11: the last has none.
LISTS: list[Any] = [[0, 1], [3], np.array([5, 6]), range(8, 10), []]


def rows(lists: list[Any]) -> np.ndarray:
    table = np.empty((len(lists), 2), object)
    for query, found in enumerate(lists):
        table[query] = [query, found]
    return table


@pytest.fixture
def routes(tmp_path: Path, draw_view: Writer) -> Path:
    for number in range(12):
        draw_view(tmp_path / "set" / "ref" / f"{number:07d}.jpg", number)
    for number, seen in enumerate((0, 3, 5, 8, 30)):
        draw_view(tmp_path / "set" / "query" / f"{number:07d}.jpg", seen, size=(160, 48) if number < 4 else (200, 80))
    np.save(tmp_path / "set" / "ground_truth_new.npy", rows(LISTS))
    (tmp_path / "my.toml").write_text('[routes.bench]\nreader = "vpr-bench"\nfolder = "set"\n')
    return tmp_path / "my.toml"


def test_the_truth_is_what_the_file_lists(routes: Path) -> None:
    route = load_route("bench", routes=routes)
    assert route.unit == "frames"
    assert [np.flatnonzero(row).tolist() for row in route.visit.answers] == [[0, 1], [3], [5, 6], [8, 9], []]
    assert route.visit.rule.startswith("learn frames that ground_truth_new.npy lists for the query; 1 of 5")
    assert len(route.learn) == 12


def test_a_row_is_judged_by_the_lists(routes: Path) -> None:
    (outcome,) = run(Job("bench", "CoHOG", 0, "cohog", (Cell("bench", "CoHOG", 1.0, 0),)), routes_file=routes)
    assert outcome.row["error"] == ""
    assert (outcome.row["unit"], outcome.row["places"]) == ("frames", 12)
    assert outcome.trace is not None
    # The fifth query has no right reference: it counts as wrong.
    assert outcome.trace.correct.tolist() == [True, True, True, True, False]
    assert outcome.trace.correct_metric.tolist() == [True, True, True, True, False]
    assert outcome.trace.error_m[:4].tolist() == [0, 0, 0, 0]
    assert np.isnan(outcome.trace.error_m[4])
    assert outcome.trace.truth[4] == -1


def test_place_fields_need_no_truth(routes: Path) -> None:
    route = load_route("bench", routes=routes)
    fields = record_fields(route, fitted_agent({"localizer": "cohog"}, 0, ()), 3.0, agent="CoHOG")
    assert fields.places.tolist() == [0, 3, 6, 9]
    assert fields.winners[fields.places].tolist() == [0, 1, 2, 3]


def test_what_is_not_there_is_named(routes: Path) -> None:
    (routes.parent / "set" / "ground_truth_new.npy").unlink()
    with pytest.raises(
        DataError, match=r"ground_truth_new\.npy, a file that is not there.*beside the data set's query"
    ):
        load_route("bench", routes=routes)
    assert not catalogue(routes).availability("bench").complete


@pytest.mark.parametrize(
    ("lists", "fault"),
    [
        ([[0], [1], [2], [3]], r"no row for query 4; take its image away, or add a row with an empty list"),
        ([[0], [1], [2], [3], [12]], "query 4 has the reference 12, of which there is no image"),
        ([[0], [1], [2], [3], [-1]], "query 4 has the reference -1, of which there is no image"),
        ([[0], [1], [2], [3], ["4"]], r"row 4: '4' is not the number of an image"),
        ([[0], [1], [2], [3], [0.5]], r"row 4: 0\.5 is not the number of an image"),
        ([[0], [1], [2], [3], [float("nan")]], r"row 4: nan is not the number of an image"),
        ([[0], [1], [2], [3], None], r"row 4: None is not the number of an image"),
    ],
)
def test_lists_that_do_not_fit_the_images_are_refused(routes: Path, lists: list[Any], fault: str) -> None:
    np.save(routes.parent / "set" / "ground_truth_new.npy", rows(lists))
    with pytest.raises(DataError, match=r"ground_truth_new\.npy.*" + fault):
        load_route("bench", routes=routes)


def test_other_shapes_and_twice_named_queries_are_refused(tmp_path: Path) -> None:
    path, numbers = tmp_path / "truth.npy", np.arange(3)
    np.save(path, np.zeros((3, 3)))
    with pytest.raises(DataError, match=r"truth\.npy: an array of shape \(3, 3\)"):
        read_matches(path, numbers, numbers)
    np.save(path, np.array([[0, 1], [0, 2]]))
    with pytest.raises(DataError, match=r"truth\.npy, row 1: query 0 a second time"):
        read_matches(path, numbers, numbers)
    np.save(path, np.array([[0, 2], [1, 1], [2, 0]]))
    assert read_matches(path, numbers, numbers).astype(int).tolist() == [[0, 0, 1], [0, 1, 0], [1, 0, 0]]


@pytest.mark.parametrize("protocol", range(5))
@pytest.mark.parametrize("core", [b"numpy._core", b"numpy.core"])
def test_pickles_of_every_age_are_read(tmp_path: Path, protocol: int, core: bytes) -> None:
    np.save(tmp_path / "new.npy", rows(LISTS))
    head = (tmp_path / "new.npy").read_bytes()[:128]
    table = rows([*LISTS, [np.int64(7), np.float64(8)]])
    # NumPy itself writes protocol 2 to 4, of which 4 writes the length of a name before it.
    old = pickle.dumps(table, protocol)
    body = old.replace(b"numpy._core", core) if protocol < 4 else old
    (tmp_path / "old.npy").write_bytes(head + body)
    again = read_objects(tmp_path / "old.npy")
    assert [list(found) for found in again[:, 1]] == [list(found) for found in table[:, 1]]


class Malice:
    """A pickle that makes a file when it is loaded."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        return os.mkdir, (str(self.path),)


def test_a_malicious_pickle_does_not_run(tmp_path: Path) -> None:
    path, trap = tmp_path / "truth.npy", tmp_path / "trap"
    np.save(path, rows([[Malice(trap)]]))
    with pytest.raises(DataError, match=r"truth\.npy: not readable .*it would run (posix|nt)\.mkdir, which is no data"):
        read_objects(path)
    assert not trap.exists()
    # The trap would have sprung in NumPy's own hands.
    np.load(path, allow_pickle=True)
    assert trap.exists()


@pytest.mark.parametrize("module", ["builtins.eval", "os.system", "numpy.load", "numpy.f2py.compile", "codecs.decode"])
def test_no_other_name_is_admitted(tmp_path: Path, module: str) -> None:
    np.save(tmp_path / "x.npy", rows(LISTS))
    head = (tmp_path / "x.npy").read_bytes()[:128]
    package, name = module.rsplit(".", 1)
    (tmp_path / "x.npy").write_bytes(head + f"c{package}\n{name}\n(S'1'\ntR.".encode())
    with pytest.raises(DataError, match=f"it would run {module}, which is no data"):
        read_objects(tmp_path / "x.npy")


@pytest.mark.parametrize("size", [0, 5, 60, 127, 128, 140, 200])
def test_a_file_cut_off_is_refused(tmp_path: Path, size: int) -> None:
    np.save(tmp_path / "x.npy", rows(LISTS))
    whole = (tmp_path / "x.npy").read_bytes()
    (tmp_path / "x.npy").write_bytes(whole[:size])
    with pytest.raises(DataError, match=r"x\.npy: not readable as an array of lists") as error:
        read_objects(tmp_path / "x.npy")
    assert "\n" not in str(error.value)
