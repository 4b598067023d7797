from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from vprbench_encoders.resolution import reduced
from vprbench_encoders.whitening import radial_gain, whiten


def test_the_gain_is_olshausen_and_fields() -> None:
    # f exp(-(f/f0)^4) rises as f, and peaks where 4 (f/f0)^4 = 1.
    peak = 0.39 / 4**0.25
    np.testing.assert_allclose(radial_gain(np.array([0.0, peak])), [0.0, peak * np.exp(-0.25)])
    around = radial_gain(np.linspace(peak - 0.01, peak + 0.01, 101))
    assert around.argmax() == 50


@pytest.mark.parametrize(("across", "down"), [(8, 0), (0, 5), (20, 6), (36, 12)])
def test_a_wave_is_scaled_by_the_gain_at_its_frequency(across: int, down: int) -> None:
    rows, columns = 96, 160
    v, u = np.mgrid[:rows, :columns]
    # A cosine about pixel edges is its own reflection at the border, so the filter sees it without an end.
    wave = np.cos(np.pi * across / columns * (u + 0.5)) * np.cos(np.pi * down / rows * (v + 0.5))
    gain = radial_gain(np.hypot([across / columns], [down / rows]) / 2)
    np.testing.assert_allclose(whiten(wave.astype(np.float32)), gain * wave, atol=1.2e-3)


def test_it_is_the_filter_that_numpy_computes_in_the_fourier_domain() -> None:
    image = np.random.default_rng(0).random((94, 321), np.float32)
    padded = np.pad(image.astype(np.float64), 150, mode="symmetric")
    fv, fu = np.fft.fftfreq(padded.shape[0])[:, None], np.fft.fftfreq(padded.shape[1])
    expected = np.fft.ifft2(np.fft.fft2(padded) * radial_gain(np.hypot(fv, fu))).real[150:-150, 150:-150]
    np.testing.assert_allclose(whiten(image), expected, atol=0.02 * expected.std())


def test_a_spectrum_that_falls_as_one_over_f_becomes_flat() -> None:
    rng = np.random.default_rng(0)
    frequency = np.hypot(np.fft.fftfreq(256)[:, None], np.fft.fftfreq(256))
    frequency[0, 0] = 1
    pink = np.fft.ifft2(np.fft.fft2(rng.standard_normal((256, 256))) / frequency).real.astype(np.float32)
    window = np.outer(np.hanning(256), np.hanning(256))
    power = np.abs(np.fft.fft2(whiten(pink) * window))
    bands = [power[(frequency > low) & (frequency < low + 0.04)].mean() for low in (0.04, 0.1, 0.16)]
    assert max(bands) / min(bands) < 1.1


def test_the_mean_goes_and_a_constant_becomes_zero() -> None:
    np.testing.assert_allclose(whiten(np.full((94, 321), 130, np.float32)), 0.0, atol=1e-3)


def test_halving_averages_two_by_two() -> None:
    image = np.random.default_rng(0).random((188, 642), np.float32)
    expected = image.reshape(94, 2, 321, 2).mean(axis=(1, 3))
    np.testing.assert_allclose(reduced(image, 2), expected, atol=1e-6)


def test_whitening_comes_after_halving() -> None:
    # Halving takes away frequencies that whitening would have raised: the order matters, and this is ours.
    frame = gaussian_filter(np.random.default_rng(0).random((188, 642), np.float32), 1)
    first, last = whiten(reduced(frame, 2)), reduced(whiten(frame), 2)
    assert np.corrcoef(first.ravel(), last.ravel())[0, 1] < 0.95
