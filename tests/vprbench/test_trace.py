"""A trace keeps every value, refuses contradictions, and reads back only what is whole."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from vprbench.errors import DataError
from vprbench.trace import Trace

NONE = float("nan")


@pytest.fixture
def trace() -> Trace:
    return Trace(
        frame=np.arange(100, 104),
        truth=np.array([0, 1, -1, 2]),
        hypothesis=np.array([0, 2, -1, 2]),
        confidence=np.array([0.25, 1 / 3, 0.0, 1.0]),
        error_m=np.array([0.1, 7.5, NONE, 0.0]),
        tolerance_m=np.array([0.3, 0.4, 0.5, 0.6]),
        correct=np.array([True, False, False, True]),
        correct_metric=np.array([True, False, False, True]),
        rank=np.array([0, 1, -1, 0]),
        rank_metric=np.array([0, 2, -1, 0]),
        east=np.array([0.0, 1.0, 2.0, 3.5]),
        north=np.array([-0.0, 1e-300, -1e9, 2.0]),
    )


def test_every_bit_survives_the_file(trace: Trace, tmp_path: Path) -> None:
    path = tmp_path / "new folder" / "a=b" / "cell.parquet"
    trace.save(path)
    loaded = Trace.load(path)
    for name, column in trace.to_frame().items():
        assert getattr(loaded, str(name)).dtype == column.dtype
        assert getattr(loaded, str(name)).tobytes() == column.to_numpy().tobytes(), name


def test_the_same_trace_gives_the_same_bytes(trace: Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "a.parquet")
    Trace.load(tmp_path / "a.parquet").save(tmp_path / "b.parquet")
    assert (tmp_path / "a.parquet").read_bytes() == (tmp_path / "b.parquet").read_bytes()


def test_a_failed_save_leaves_the_old_file_and_nothing_else(
    trace: Trace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "cell.parquet"
    trace.save(path)
    before = path.read_bytes()

    def half_written(table: object, where: Path, **options: object) -> None:
        where.write_bytes(b"PAR1")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pq, "write_table", half_written)
    with pytest.raises(DataError, match=r"cell\.parquet: the trace cannot be written \(No space left on device\)"):
        replace(trace, rank=np.array([0, 5, -1, 0])).save(path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_that_was_cut_short_is_refused(trace: Trace, tmp_path: Path) -> None:
    path = tmp_path / "cell.parquet"
    trace.save(path)
    content = path.read_bytes()
    for length in range(0, len(content), 97):
        path.write_bytes(content[:length])
        with pytest.raises(DataError, match=r"cell\.parquet: not a readable trace"):
            Trace.load(path)


def test_a_flipped_bit_never_changes_a_value(trace: Trace, tmp_path: Path) -> None:
    path = tmp_path / "cell.parquet"
    long = Trace.from_frame(pd.concat([trace.to_frame()] * 25, ignore_index=True))
    long.save(path)
    content = path.read_bytes()
    refused = 0
    # Every byte of the footer, which no checksum guards, and some of the data.
    positions = [*range(0, len(content), 7), *range(len(content) - 1200, len(content))]
    for position in positions:
        path.write_bytes(content[:position] + bytes([content[position] ^ 1]) + content[position + 1 :])
        try:
            pd.testing.assert_frame_equal(Trace.load(path).to_frame(), long.to_frame())
        except DataError as error:
            assert str(path) in str(error)
            refused += 1
    assert refused > len(positions) / 2


def test_other_files_are_refused_by_name(tmp_path: Path) -> None:
    (tmp_path / "text.parquet").write_text("not Parquet at all")
    pd.DataFrame({"frame": [1]}).to_parquet(tmp_path / "other.parquet")
    with pytest.raises(DataError, match=r"text\.parquet: not a readable trace"):
        Trace.load(tmp_path / "text.parquet")
    with pytest.raises(DataError, match=r"other\.parquet: .*needs the column 'truth'"):
        Trace.load(tmp_path / "other.parquet")
    with pytest.raises(DataError, match=r"missing\.parquet: not a readable trace"):
        Trace.load(tmp_path / "missing.parquet")
    with pytest.raises(DataError, match="not a readable trace"):
        Trace.load(tmp_path)


def test_unknown_and_missing_columns_are_named(trace: Trace) -> None:
    with pytest.raises(DataError, match="needs the column 'confidence'"):
        Trace.from_frame(trace.to_frame().drop(columns="confidence"))
    with pytest.raises(DataError, match="no column 'confidense': did you mean 'confidence'"):
        Trace.from_frame(trace.to_frame().assign(confidense=0.0))


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"confidence": [0.5, NONE, 0.0, 1.0]}, r"confidence is not a number from 0 up \(frame 101, 1 in all\)"),
        ({"confidence": [0.5, np.inf, 0.0, -1.0]}, r"confidence is not a number from 0 up \(frame 101, 2 in all\)"),
        ({"confidence": [0.5, 0.5, 0.1, 1.0]}, r"no hypothesis, but a confidence above 0 \(frame 102"),
        ({"correct": [True, False, True, True]}, r"no hypothesis, but marked right \(frame 102"),
        ({"correct": [True, True, False, True]}, r"correct and rank 0 contradict each other \(frame 101"),
        ({"rank_metric": [0, 2, -1, 1]}, r"correct_metric and rank_metric 0 contradict each other \(frame 103"),
        ({"tolerance_m": [0.1, 0.2]}, r"tolerance_m has shape \(2,\), but frame \(4,\)"),
        ({"frame": [1.0, 2.0, 3.0, 4.5]}, "frame holds float64 values, not int64"),
        ({"correct": [1, 0, 0, 1]}, "correct holds int64 values, not bool"),
    ],
)
def test_contradictions_are_refused(trace: Trace, changes: dict[str, Any], reason: str) -> None:
    with pytest.raises(DataError, match=reason):
        replace(trace, **{name: np.array(values) for name, values in changes.items()})


def test_a_trace_without_rows_is_refused(trace: Trace) -> None:
    with pytest.raises(DataError, match=r"frame has shape \(0,\)"):
        Trace.from_frame(trace.to_frame().iloc[:0])


def test_narrower_types_are_widened(trace: Trace) -> None:
    small = replace(trace, rank=trace.rank.astype(np.int16), confidence=trace.confidence.astype(np.float32))
    assert small.rank.dtype == np.int64
    assert small.confidence.dtype == np.float64
