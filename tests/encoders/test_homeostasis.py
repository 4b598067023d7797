from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from vprbench_encoders.homeostasis import Kind, homeostasis, usage, usage_entropy
from vprbench_encoders.matching_pursuit import SCALE, SparseCode, by_correlation, pursue
from vprbench_encoders.sparse_hebbian import SparseHebbian, unit_length


def sparse(rows: list[list[tuple[int, float]]]) -> SparseCode:
    """Codes given as (atom, value) pairs, the same number in each row."""
    cells = np.array(rows)
    return SparseCode(cells[..., 0].astype(np.int32), cells[..., 1].astype(np.float32))


CODE = sparse([[(0, 2.0), (1, 5.0)], [(0, 1.0), (0, 0.0)], [(2, 9.0), (0, 3.0)], [(1, 0.5), (0, 0.0)]])


def test_usage_counts_the_samples_that_an_atom_takes_part_in() -> None:
    np.testing.assert_allclose(usage(CODE, 4), [3 / 4, 2 / 4, 1 / 4, 0])


def test_entropy_is_one_for_equal_use_and_zero_for_one_atom() -> None:
    assert usage_entropy(usage(sparse([[(0, 1.0)], [(1, 2.0)], [(2, 0.1)], [(3, 1.0)]]), 4)) == pytest.approx(1)
    assert usage_entropy(usage(sparse([[(2, 1.0)], [(2, 2.0)]]), 4)) == 0
    assert usage_entropy(usage(CODE, 4)) == pytest.approx(
        -(3 / 6 * np.log(3 / 6) + 2 / 6 * np.log(2 / 6) + 1 / 6 * np.log(1 / 6)) / np.log(4)
    )


def test_tables_follow_the_distribution_of_each_atom_zeros_counted() -> None:
    balance = homeostasis("heh", atoms=4, picks=2, rate=1.0, bins=8)
    np.testing.assert_allclose(balance.selection.tables, np.tile(np.linspace(0, 1, 9), (4, 1)), atol=1e-6)
    balance.update(CODE)
    dense = np.array([[2, 5, 0, 0], [1, 0, 0, 0], [3, 0, 9, 0], [0, 0.5, 0, 0]])
    edges = -SCALE * np.log(1 - np.arange(1, 9) / 8.0 + 1e-12)
    expected = [[np.mean(column < edge) for edge in edges] for column in dense.T]
    np.testing.assert_allclose(balance.selection.tables[:, 1:], expected, atol=1e-6)
    np.testing.assert_array_equal(balance.selection.tables[:, 0], 0)


def test_tables_move_by_the_rate() -> None:
    slow, fast = (homeostasis("heh", 4, 2, rate, 8) for rate in (0.1, 1.0))
    start = slow.selection.tables.copy()
    slow.update(CODE)
    fast.update(CODE)
    np.testing.assert_allclose(slow.selection.tables, 0.9 * start + 0.1 * fast.selection.tables, atol=1e-6)


def test_the_gain_is_perrinets() -> None:
    balance = homeostasis("hap", atoms=4, picks=2, rate=0.5, bins=8)
    np.testing.assert_array_equal(balance.selection.gain, 1)
    balance.update(CODE)
    p = 0.5 * 0.5 + 0.5 * np.array([3 / 4, 2 / 4, 1 / 4, 0])
    np.testing.assert_allclose(balance.selection.gain, np.log(p) / np.log(0.5), rtol=1e-6)


def test_without_homeostasis_nothing_changes() -> None:
    balance = homeostasis("none", 4, 2, 0.5, 8)
    balance.update(CODE)
    np.testing.assert_array_equal(balance.selection.gain, by_correlation(4).gain)
    assert balance.selection.tables.shape == (0, 0)


def crowded() -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Signals that share one strong direction, and atoms of which some point there and most do not."""
    rng = np.random.default_rng(0)
    common = rng.standard_normal(30)
    signals = rng.standard_normal((1500, 30)) + 2.5 * common
    atoms = rng.standard_normal((60, 30))
    atoms[:5] += 2 * common
    return (signals / np.sqrt(np.square(signals).mean(axis=1, keepdims=True))).astype(np.float32), unit_length(
        atoms.astype(np.float32)
    )


def test_homeostasis_evens_out_the_use_of_atoms_and_its_absence_does_not() -> None:
    signals, atoms = crowded()
    entropy = {}
    for kind in ("none", "heh", "hap"):
        balance = homeostasis(kind, 60, 4, 0.05, 128)
        for _ in range(100):
            balance.update(pursue(signals, atoms, atoms @ atoms.T, 4, balance.selection))
        entropy[kind] = usage_entropy(usage(pursue(signals, atoms, atoms @ atoms.T, 4, balance.selection), 60))
    assert entropy["none"] < 0.9
    assert entropy["heh"] > entropy["none"] + 0.06
    assert entropy["hap"] > entropy["none"] + 0.06


@pytest.mark.parametrize("kind", ["heh", "hap"])
def test_an_atom_that_fits_nothing_is_never_forced_on_a_signal(kind: Kind) -> None:
    # Atom 1 opposes every signal: however rarely it is used, it must not be picked.
    atoms = np.array([[1, 0], [-1, 0]], np.float32)
    signals = np.array([[1, 1], [1, -1]], np.float32)
    balance = homeostasis(kind, 2, 1, 0.5, 16)
    for _ in range(30):
        code = pursue(signals, atoms, atoms @ atoms.T, 1, balance.selection)
        np.testing.assert_array_equal(code.atoms, 0)
        balance.update(code)


def test_a_learned_dictionary_is_used_more_evenly_with_homeostasis() -> None:
    signals, _ = crowded()
    entropy = {}
    for kind in ("none", "heh", "hap"):
        learning = SparseHebbian(picks=4, homeostasis=kind, homeostasis_rate=0.05, rule="plain", rate=0.02, batch=300)
        atoms = learning.learn(signals, 60, np.random.default_rng(0))
        # Rules of competition end with learning: what is left is what the atoms themselves have become.
        entropy[kind] = usage_entropy(usage(learning.code(signals, atoms, by_correlation(60)), 60))
    assert min(entropy["heh"], entropy["hap"]) > entropy["none"] + 0.1, entropy
