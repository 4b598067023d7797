"""Whitening: a filter after which every spatial frequency of a natural image counts alike, but the noisy finest.

B. A. Olshausen, D. J. Field, "Sparse coding with an overcomplete basis set: a strategy employed by V1?", Vision
Research 1997. The amplitudes of natural images fall as 1/f, so the gain f flattens them, and exp(-(f/f0)^4) takes
off the corners of the spectrum, where there is mostly noise.
"""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np
from jaxtyping import Float32, Float64

__all__ = ["CUTOFF", "radial_gain", "whiten"]

# f0 in cycles per pixel, as public code of sparse Hebbian learning has it.
CUTOFF = 0.39

# The filter's reach in pixels: beyond it lies less than 1e-5 of the energy of its kernel.
_MARGIN = 16


def radial_gain(frequency: Float64[np.ndarray, "..."], cutoff: float = CUTOFF) -> Float64[np.ndarray, "..."]:
    """The filter's gain f exp(-(f/f0)^4) at each frequency, cycles per pixel."""
    return frequency * np.exp(-((frequency / cutoff) ** 4))


def whiten(image: Float32[np.ndarray, "height width"], cutoff: float = CUTOFF) -> Float32[np.ndarray, "height width"]:
    """The whitened image; beyond its border it is taken to be reflected."""
    height, width = image.shape
    rows, columns = (cv2.getOptimalDFTSize(side + 2 * _MARGIN) for side in image.shape)
    margins = _MARGIN, rows - height - _MARGIN, _MARGIN, columns - width - _MARGIN
    padded = cv2.copyMakeBorder(image, *margins, borderType=cv2.BORDER_REFLECT)
    product = cv2.mulSpectrums(cv2.dft(padded), _spectrum(rows, columns, cutoff), 0)
    filtered = cv2.idft(product, flags=cv2.DFT_SCALE)
    return filtered[_MARGIN : _MARGIN + height, _MARGIN : _MARGIN + width]


@lru_cache(maxsize=8)
def _spectrum(rows: int, columns: int, cutoff: float) -> Float32[np.ndarray, "rows columns"]:
    """The filter's spectrum, packed as OpenCV packs that of a real image (it multiplies in half the time)."""
    frequency = np.hypot(np.fft.fftfreq(rows)[:, None], np.fft.rfftfreq(columns))
    kernel = np.fft.irfft2(radial_gain(frequency, cutoff), s=(rows, columns))
    return cv2.dft(kernel.astype(np.float32))
