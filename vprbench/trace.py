"""What a test drive left behind: one row a test frame, enough to score it again without the localizer.

A worker of a sweep makes traces but writes none: pandas and pyarrow are imported by whoever does.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Bool, Float64, Int64

from vprbench.atomic import replacing
from vprbench.errors import DataError, nearest
from vprbench.readers.number_files import LARGEST
from vprbench.types import NO_PLACE

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["Trace"]

DTYPES = {
    "frame": np.int64,
    "truth": np.int64,
    "hypothesis": np.int64,
    "confidence": np.float64,
    "error_m": np.float64,
    "tolerance_m": np.float64,
    "correct": np.bool_,
    "correct_metric": np.bool_,
    "rank": np.int64,
    "rank_metric": np.int64,
    "east": np.float64,
    "north": np.float64,
}

# The checksum tells damage; without statistics and Arrow's own schema the file is half as large.
PARQUET: dict[str, Any] = {
    "compression": "zstd",
    "write_page_checksum": True,
    "write_statistics": False,
    "store_schema": False,
}


@dataclass(frozen=True, eq=False)
class Trace:
    """One test drive as arrays with one row a test frame, in driving order.

    Attributes:
        frame: number of the test frame in its data set.
        truth: the place that won the record phase at the nearest learn frame, -1 for none.
        hypothesis: the place that the localizer answered, -1 for none.
        confidence: its response, 0..1; 0 where there is no hypothesis.
        error_m: distance from where the hypothesised place was learned to the query, NaN where nobody knows.
        tolerance_m: d_NN, the distance from the query to its nearest learn frame.
        correct: right by the place-field rule.
        correct_metric: right by the metric rule, error_m <= sampling distance / 2 + tolerance_m.
        rank: rank (from 0) of the best-ranked place that is right by the place-field rule, -1 for none.
        rank_metric: the same by the metric rule.
        east: position of the query, local metres.
        north: position of the query, local metres.

    Raises:
        DataError: no rows, columns of different length or type, a confidence that is not a number or negative, a
            position or distance that is none, or a row that contradicts itself.
    """

    frame: Int64[np.ndarray, " queries"]
    truth: Int64[np.ndarray, " queries"]
    hypothesis: Int64[np.ndarray, " queries"]
    confidence: Float64[np.ndarray, " queries"]
    error_m: Float64[np.ndarray, " queries"]
    tolerance_m: Float64[np.ndarray, " queries"]
    correct: Bool[np.ndarray, " queries"]
    correct_metric: Bool[np.ndarray, " queries"]
    rank: Int64[np.ndarray, " queries"]
    rank_metric: Int64[np.ndarray, " queries"]
    east: Float64[np.ndarray, " queries"]
    north: Float64[np.ndarray, " queries"]

    def __post_init__(self) -> None:
        for name in DTYPES:
            object.__setattr__(self, name, self._typed(name))
        none = self.hypothesis == NO_PLACE
        # How far off an answer is, nobody knows where there is none, or where a data set lists no right one.
        unknown = none | (self.truth == NO_PLACE)
        for name in ("east", "north", "tolerance_m", "error_m"):
            known = np.abs(getattr(self, name)) <= LARGEST
            self._refuse(~(known | unknown & (name == "error_m")), f"{name} is not a number of metres")
        self._refuse(~(np.isfinite(self.confidence) & (self.confidence >= 0)), "confidence is not a number from 0 up")
        self._refuse(none & (self.confidence > 0), "no hypothesis, but a confidence above 0")
        self._refuse(none & (self.correct | self.correct_metric), "no hypothesis, but marked right")
        self._refuse(self.correct != (self.rank == 0), "correct and rank 0 contradict each other")
        self._refuse(
            self.correct_metric != (self.rank_metric == 0), "correct_metric and rank_metric 0 contradict each other"
        )

    def __len__(self) -> int:
        return len(self.frame)

    def to_frame(self) -> pd.DataFrame:
        """The same rows as a table, one column an attribute."""
        import pandas as pd

        return pd.DataFrame(self._columns())

    @classmethod
    def from_frame(cls, frame: pd.DataFrame) -> Trace:
        """The trace in a table that has exactly the columns of `to_frame`.

        Raises:
            DataError: a column is missing or unknown, or its values are refused.
        """
        missing = [name for name in DTYPES if name not in frame.columns]
        if missing:
            raise DataError(f"a trace needs the column {missing[0]!r}; present: {', '.join(map(str, frame.columns))}")
        unknown = [str(name) for name in frame.columns if name not in DTYPES]
        if unknown:
            raise DataError(f"a trace has no column {unknown[0]!r}: {nearest(unknown[0], DTYPES)}")
        return cls(**{name: frame[name].to_numpy() for name in DTYPES})

    def save(self, path: Path) -> None:
        """Write a Parquet file: whole or not at all, and the same bytes for the same trace.

        Raises:
            DataError: the file cannot be written.
        """
        import pyarrow as pa
        import pyarrow.parquet as pq

        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with replacing(path) as temporary:
                pq.write_table(pa.table(self._columns()), temporary, **PARQUET)
        except OSError as error:
            raise DataError(f"{path}: the trace cannot be written ({error.strerror or error})") from error

    @classmethod
    def load(cls, path: Path) -> Trace:
        """Read what `save` wrote.

        Raises:
            DataError: the file is missing, damaged or not a trace.
        """
        import pyarrow as pa
        import pyarrow.parquet as pq

        try:
            with pq.ParquetFile(path, page_checksum_verification=True) as file:
                rows, table = file.metadata.num_rows, file.read(use_threads=False)
            if table.num_rows != rows:
                raise DataError(f"{table.num_rows} of {rows} rows")
            return cls.from_frame(table.to_pandas())
        except (OSError, ValueError, pa.ArrowException, DataError) as error:
            reason = str(error).split("\n")[0]
            mend = "measure its cell again: vprbench sweep NAME --overwrite --filter CELL"
            raise DataError(f"{path}: not a readable trace ({reason}); {mend}") from error

    def _columns(self) -> dict[str, np.ndarray]:
        return {name: getattr(self, name) for name in DTYPES}

    def _typed(self, name: str) -> np.ndarray:
        """One column as an array of its own type and of the common length."""
        values, rows = np.asarray(getattr(self, name)), np.shape(self.frame)
        if values.ndim != 1 or values.shape != rows or not values.size:
            raise DataError(f"trace: {name} has shape {values.shape}, but frame {rows}; both must be (queries,)")
        if not np.can_cast(values.dtype, DTYPES[name], "same_kind"):
            raise DataError(f"trace: {name} holds {values.dtype} values, not {np.dtype(DTYPES[name])}")
        return values.astype(DTYPES[name], copy=False)

    def _refuse(self, bad: Bool[np.ndarray, " queries"], reason: str) -> None:
        if bad.any():
            raise DataError(f"trace: {reason} (frame {self.frame[bad.argmax()]}, {bad.sum()} in all)")
