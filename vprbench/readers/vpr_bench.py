"""VPR-Bench's layout: `query/`, `ref/`, and a file that lists the right references of each query.

Zaffar et al., "VPR-Bench: an open-source visual place recognition evaluation framework with quantifiable viewpoint and
appearance change", IJCV 2021. `ground_truth_new.npy` has a row for each query: its number, and the numbers of the
references that show its place.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Int64

from vprbench.errors import DataError
from vprbench.readers.safe_npy import read_objects

__all__ = ["read_matches"]


def read_matches(
    path: Path, queries: Int64[np.ndarray, " queries"], references: Int64[np.ndarray, " frames"]
) -> Bool[np.ndarray, "queries frames"]:
    """Which references are right for each query.

    Args:
        path: the file of the ground truth.
        queries: the number of each query image.
        references: the number of each reference image, increasing.

    Raises:
        DataError: the file cannot be read, or a row is not a query's number and a list of references that are there.
    """
    table = read_objects(path)
    if table.ndim != 2 or table.shape[1] != 2:
        raise DataError(
            f"{path}: an array of shape {table.shape}, where a query's number and its list are due in a row"
        )
    lists: dict[int, list[int]] = {}
    for row, (query, found) in enumerate(table):
        number = _whole(query, f"{path}, row {row}")
        if number in lists:
            raise DataError(f"{path}, row {row}: query {number} a second time")
        lists[number] = [_whole(one, f"{path}, row {row}") for one in _each(found)]
    return _marks(path, lists, queries, references)


def _marks(
    path: Path,
    lists: Mapping[int, list[int]],
    queries: Int64[np.ndarray, " queries"],
    references: Int64[np.ndarray, " frames"],
) -> Bool[np.ndarray, "queries frames"]:
    columns = {int(number): column for column, number in enumerate(references)}
    marks = np.zeros((len(queries), len(references)), bool)
    for row, query in enumerate(map(int, queries)):
        if query not in lists:
            raise DataError(f"{path}: no row for query {query}; take its image away, or add a row with an empty list")
        for number in lists[query]:
            if number not in columns:
                raise DataError(f"{path}: query {query} has the reference {number}, of which there is no image")
            marks[row, columns[number]] = True
    return marks


def _each(found: object) -> Iterable[object]:
    """The members of a list; a single number is a list of one."""
    if isinstance(found, np.ndarray):
        return list(found.ravel())
    return found if isinstance(found, list | tuple | range) else [found]


def _whole(value: object, where: str) -> int:
    if isinstance(value, int | float | np.integer | np.floating) and float(value).is_integer():
        return int(value)
    raise DataError(f"{where}: {value!r} is not the number of an image")
