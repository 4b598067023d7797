from __future__ import annotations

import subprocess
import sys

import llvmlite.binding as llvm  # type: ignore[import-untyped]
import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from vprbench_localizers.region_match import REGIONS, describe_regions, match_rows, room_to_match
from vprbench_localizers.wide_vectors import use_wide_vectors

Values = NDArray[np.float32]
FEATURES = llvm.get_host_cpu_features()
HAS_WIDE = FEATURES.get("avx512f", False)


def plain(scale: Values, values: Values, sums: Values) -> None:
    for i in range(len(sums)):
        sums[i] += scale[0] * values[i]


def hinted(scale: Values, values: Values, sums: Values) -> None:
    use_wide_vectors()
    for i in range(len(sums)):
        sums[i] += scale[0] * values[i]


def shares() -> NDArray[np.float64]:
    """What each row of a random query's regions adds to the scores of five random places."""
    random = np.random.default_rng(0)
    query, *places = (describe_regions(cells, np.ones((31, 31), bool)) for cells in random.random((6, 32, 32, 8)))
    asking, buffers, rows = room_to_match(query)
    answer = []
    for place in places:
        match_rows(asking, place.planes, 0, REGIONS, buffers, rows)
        answer.append(rows.copy())
    return np.array(answer)


def test_a_kernel_gets_vectors_of_512_bits_and_no_check_of_overlaps_where_there_are_any() -> None:
    scale, values, sums = np.full(1, 2, np.float32), np.arange(1000, dtype=np.float32), np.ones(1000, np.float32)
    # Kernels that were read from numba's cache show no code, and those that check bounds have no vectors.
    before, kernel = njit(boundscheck=False)(plain), njit(boundscheck=False)(hinted)
    before(scale, values, np.ones_like(sums))
    kernel(scale, values, sums)
    (code,), (checked,), (unchecked,) = (
        texts.values() for texts in (kernel.inspect_asm(), before.inspect_llvm(), kernel.inspect_llvm())
    )
    assert sums.tolist() == [2 * value + 1 for value in range(1000)]
    assert "vector.memcheck" in checked
    assert ("vector.memcheck" not in unchecked) == HAS_WIDE
    assert ("%zmm" in code) == HAS_WIDE


def test_what_a_row_adds_does_not_depend_on_the_width_of_vectors_by_one_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    narrow = [f"{'+' if has and 'avx512' not in name else '-'}{name}" for name, has in FEATURES.items()]
    monkeypatch.setenv("NUMBA_CPU_FEATURES", ",".join(narrow))
    program = f"from runpy import run_path; print(run_path({__file__!r})['shares']().tobytes().hex())"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == shares().tobytes().hex()
