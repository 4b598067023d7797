"""Fixes of a navigation system, and where a vehicle was at the times between them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float64, Int64

from vprbench.errors import DataError
from vprbench.geodesy import check_geodetic, wrap
from vprbench.readers.csv_table import CsvTable, read_csv
from vprbench.readers.number_files import check_increasing

__all__ = ["LONGEST_GAP", "Fixes", "read_fixes"]

# Microseconds between two fixes between which a position is interpolated. Our choice: a car's length or two in a town.
LONGEST_GAP = 1_000_000

_GOOD = "INS_SOLUTION_GOOD"


@dataclass(frozen=True)
class Fixes:
    """Where a vehicle was, at increasing times.

    Attributes:
        times: (n,) microseconds.
        geodetic: (n, 2) latitude and longitude, degrees.
        yaw: (n,) radians clockwise from north; None where the system knows none.
    """

    times: Int64[np.ndarray, " n"]
    geodetic: Float64[np.ndarray, "n 2"]
    yaw: Float64[np.ndarray, " n"] | None

    def cover(self, times: Int64[np.ndarray, " m"]) -> Bool[np.ndarray, " m"]:
        """Which times lie at a fix, or between two fixes that are no more than `LONGEST_GAP` apart."""
        after = np.searchsorted(self.times, times)
        inside = (after < len(self.times)) & (times >= self.times[0])
        upper = self.times[after.clip(max=len(self.times) - 1)]
        lower = self.times[(after - 1).clip(min=0)]
        return inside & ((upper == times) | (upper - lower <= LONGEST_GAP))

    def geodetic_at(self, times: Int64[np.ndarray, " m"]) -> Float64[np.ndarray, "m 2"]:
        """Latitude and longitude at times that the fixes cover, on the line between two fixes."""
        return np.stack([np.interp(times, self.times, column) for column in self.geodetic.T], axis=1)

    def yaw_at(self, times: Int64[np.ndarray, " m"]) -> Float64[np.ndarray, " m"] | None:
        """Radians in -pi..pi, interpolated the short way round the circle."""
        return None if self.yaw is None else wrap(np.interp(times, self.times, np.unwrap(self.yaw)))


def read_fixes(path: Path, known: Collection[str]) -> Fixes:
    """The good fixes in a CSV with the columns timestamp (microseconds), latitude and longitude, and perhaps yaw.

    Where there is a column ins_status, only fixes with INS_SOLUTION_GOOD are good.

    Raises:
        DataError: a column of another name than those known or a missing one, a bad number, times that do not
            increase, or fewer than two good fixes.
    """
    table = read_csv(path, known)
    for name in ("timestamp", "latitude", "longitude"):
        if name not in table.columns:
            raise DataError(f"{path}, line 1: no column {name!r}")
    times, geodetic = _times(table), np.stack([table.numbers("latitude"), table.numbers("longitude")], axis=1)
    check_geodetic(geodetic, table.where)
    yaw = table.numbers("yaw") if "yaw" in table.columns else None
    good = np.array([status == _GOOD for status in table.columns.get("ins_status", (_GOOD,) * len(times))], bool)
    if good.sum() < 2:
        raise DataError(f"{path}: {good.sum()} of {len(good)} fixes are {_GOOD}, and two are needed")
    return Fixes(times[good], geodetic[good], None if yaw is None else yaw[good])


def _times(table: CsvTable) -> Int64[np.ndarray, " n"]:
    words = table.columns["timestamp"]
    for row, word in enumerate(words):
        if not word.isascii() or not word.isdigit() or len(word) > 18:
            raise DataError(f"{table.where(row)}: timestamp is {word!r}, not whole microseconds")
    times = np.array([int(word) for word in words], np.int64)
    check_increasing(times / 1e6, table.where)
    return times
