from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from sklearn.decomposition import sparse_encode
from sklearn.linear_model import orthogonal_mp

from vprbench_encoders.matching_pursuit import (
    SCALE,
    Selection,
    SparseCode,
    by_correlation,
    pursue,
    reconstruction_rate,
    residuals,
)

Floats = NDArray[np.float32]
SEEDS = st.integers(0, 2**32 - 1)


def unit(rows: NDArray[np.float64]) -> NDArray[np.float32]:
    return (rows / np.linalg.norm(rows, axis=1, keepdims=True)).astype(np.float32)


def problem(seed: int, atoms: int = 40, size: int = 30, samples: int = 20) -> tuple[Floats, Floats]:
    """Signals of unit variance, and a dictionary."""
    rng = np.random.default_rng(seed)
    return rng.standard_normal((samples, size)).astype(np.float32), unit(rng.standard_normal((atoms, size)))


def orthonormal(seed: int, size: int) -> NDArray[np.float32]:
    basis: NDArray[np.float64] = np.linalg.qr(np.random.default_rng(seed).standard_normal((size, size)))[0]
    return basis.astype(np.float32)


def tables(seed: int, atoms: int, bins: int = 16) -> NDArray[np.float32]:
    """Rising tables from 0 to 1, one an atom."""
    steps = np.random.default_rng(seed).random((atoms, bins)) + 0.1
    rising = np.cumsum(steps, axis=1) / steps.sum(axis=1, keepdims=True)
    return np.column_stack([np.zeros(atoms), rising]).astype(np.float32)


def code(
    signals: Floats, dictionary: Floats, picks: int, selection: Selection | None = None, rectified: bool = True
) -> SparseCode:
    selection = selection or by_correlation(len(dictionary))
    return pursue(signals, dictionary, dictionary @ dictionary.T, picks, selection, rectified)


def dense(sparse: SparseCode, atoms: int) -> NDArray[np.float32]:
    whole = np.zeros((len(sparse.atoms), atoms), np.float32)
    for row, chosen, values in zip(whole, *sparse, strict=True):
        np.add.at(row, chosen, values)
    return whole


def naive(
    signal: Floats, dictionary: Floats, picks: int, selection: Selection, rectified: bool = True
) -> NDArray[np.float64]:
    """The equations as they stand, in float64 and without a Gram matrix."""
    phi, left, a = dictionary.astype(np.float64), signal.astype(np.float64), np.zeros(len(dictionary))
    knots = np.linspace(0, 1, selection.tables.shape[1])
    for _ in range(picks):
        c = phi @ left
        competing = np.maximum(c, 0) if rectified else np.abs(c)
        scores = selection.gain * competing
        if len(knots):
            r = 1 - np.exp(-competing / SCALE)
            scores = np.array([np.interp(r[i], knots, z) for i, z in enumerate(selection.tables)])
        best = int(scores.argmax())
        if scores[best] <= 0:
            break
        a[best] += c[best]
        left = left - c[best] * phi[best]
    return a


@settings(max_examples=25, deadline=None)
@given(seed=SEEDS, picks=st.integers(1, 12), rectified=st.booleans(), atoms=st.integers(1, 70))
def test_it_is_the_naive_loop(seed: int, picks: int, rectified: bool, atoms: int) -> None:
    signals, dictionary = problem(seed, atoms)
    selection = Selection(np.random.default_rng(seed).uniform(0.5, 2, atoms).astype(np.float32), np.empty((0, 0), "f4"))
    expected = [naive(signal, dictionary, picks, selection, rectified) for signal in signals]
    np.testing.assert_allclose(
        dense(code(signals, dictionary, picks, selection, rectified), atoms), expected, atol=1e-5
    )


@settings(max_examples=25, deadline=None)
@given(seed=SEEDS, picks=st.integers(1, 12), rectified=st.booleans(), atoms=st.integers(1, 70))
def test_tables_decide_as_in_the_naive_loop(seed: int, picks: int, rectified: bool, atoms: int) -> None:
    signals, dictionary = problem(seed, atoms)
    selection = by_correlation(atoms)._replace(tables=tables(seed, atoms))
    expected = np.array([naive(signal, dictionary, picks, selection, rectified) for signal in signals])
    got = dense(code(signals, dictionary, picks, selection, rectified), atoms)
    # Two scores within a rounding of each other may swap, but not in many of 20 samples.
    agrees = np.abs(got - expected).max(axis=1) < 1e-5
    assert agrees.sum() >= 17


@settings(max_examples=25, deadline=None)
@given(seed=SEEDS, picks=st.integers(1, 8))
def test_on_an_orthonormal_basis_it_is_orthogonal_matching_pursuit(seed: int, picks: int) -> None:
    basis = orthonormal(seed, 20)
    signals = np.random.default_rng(seed + 1).standard_normal((10, 20)).astype(np.float32)
    expected = orthogonal_mp(basis.T.astype(np.float64), signals.T.astype(np.float64), n_nonzero_coefs=picks)
    got = dense(code(signals, basis, picks, rectified=False), 20)
    np.testing.assert_allclose(got, np.reshape(expected, (20, 10)).T, atol=1e-5)


def test_its_first_pick_is_that_of_orthogonal_matching_pursuit() -> None:
    signals, dictionary = problem(0)
    expected = sparse_encode(signals, dictionary, algorithm="omp", n_nonzero_coefs=1)
    np.testing.assert_allclose(dense(code(signals, dictionary, 1, rectified=False), 40), expected, atol=1e-5)


@settings(max_examples=25, deadline=None)
@given(seed=SEEDS, rectified=st.booleans(), tabulated=st.booleans())
def test_the_residual_never_grows_and_shrinks_by_what_was_taken(seed: int, rectified: bool, tabulated: bool) -> None:
    signals, dictionary = problem(seed)
    selection = by_correlation(40)._replace(tables=tables(seed, 40)) if tabulated else by_correlation(40)
    energies = [
        np.square(residuals(signals, dictionary, code(signals, dictionary, n, selection, rectified))).sum(axis=1)
        for n in range(1, 12)
    ]
    assert (np.diff([np.square(signals).sum(axis=1), *energies], axis=0) <= 1e-4).all()


def test_an_atom_picked_again_keeps_one_slot() -> None:
    # Two atoms at 60 degrees: from (0, 1) the picks alternate, each halving what is left.
    dictionary = unit(np.array([[0.0, 1.0], [np.sqrt(3) / 2, 0.5], [-np.sqrt(3) / 2, 0.5]]))
    signal = np.array([[1.0, 0.2]], np.float32)
    sparse = code(signal, dictionary, 8)
    used = sparse.atoms[sparse.values != 0]
    assert len(used) == len(set(used)) < 8
    np.testing.assert_allclose(dense(sparse, 3)[0], naive(signal[0], dictionary, 8, by_correlation(3)), atol=1e-6)


def test_rectified_codes_are_positive_and_stop_where_nothing_correlates() -> None:
    signals, dictionary = problem(0)
    assert (code(signals, dictionary, 10).values >= 0).all()
    opposite = code(-dictionary[:1], dictionary[:1], 5)
    np.testing.assert_array_equal(opposite.values, 0)
    assert code(-dictionary[:1], dictionary[:1], 5, rectified=False).values[0, 0] == pytest.approx(-1)


def test_a_flat_signal_has_no_code() -> None:
    _, dictionary = problem(0)
    zero = np.zeros((3, 30), np.float32)
    for selection in (by_correlation(40), by_correlation(40)._replace(tables=tables(0, 40))):
        np.testing.assert_array_equal(code(zero, dictionary, 5, selection).values, 0)


def test_the_first_of_equal_atoms_is_picked() -> None:
    dictionary = unit(np.ones((5, 4)))
    assert code(np.ones((1, 4), np.float32), dictionary, 1).atoms[0, 0] == 0


def test_no_signals_have_no_codes() -> None:
    _, dictionary = problem(0)
    assert code(np.empty((0, 30), np.float32), dictionary, 5).values.shape == (0, 5)


def test_a_code_scales_with_its_signal() -> None:
    signals, dictionary = problem(0)
    np.testing.assert_allclose(
        dense(code(4 * signals, dictionary, 6), 40), 4 * dense(code(signals, dictionary, 6), 40), atol=1e-4
    )


def test_the_reconstruction_rate_is_the_share_of_energy_explained() -> None:
    basis = orthonormal(0, 10)
    signals = (np.array([[3.0, 4.0, 0, 0, 0, 0, 0, 0, 0, 0]]) @ basis).astype(np.float32)
    for picks, rate in ((1, 16 / 25), (2, 1.0)):
        assert reconstruction_rate(signals, basis, code(signals, basis, picks)) == pytest.approx(rate, abs=1e-5)
    both = np.concatenate([signals, np.zeros_like(signals)])
    assert reconstruction_rate(both, basis, code(both, basis, 1)) == pytest.approx(16 / 25, abs=1e-5)
    assert np.isnan(reconstruction_rate(both[1:], basis, code(both[1:], basis, 1)))
