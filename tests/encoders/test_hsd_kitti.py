"""What HSD learns from real frames has the properties that the paper ascribes to it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from vprbench.catalogue import load_route
from vprbench.types import Frame
from vprbench_encoders.code_match import match_pairs
from vprbench_encoders.hsd import HSD
from vprbench_encoders.layers import TopologicalLayer, prepared
from vprbench_encoders.matching_pursuit import by_correlation, pursue, reconstruction_rate
from vprbench_encoders.pooling import max_pool
from vprbench_encoders.som import topographic_error
from vprbench_encoders.sparse_hebbian import unit_length
from vprbench_encoders.stepwise import finished

pytestmark = pytest.mark.kitti

Floats = NDArray[np.float32]


@pytest.fixture(scope="module")
def frames(kitti_root: Path) -> list[Frame]:
    """Every fourth training frame of K0-2."""
    return [drive.frames[i] for drive in load_route("KITTI-K0-2", kitti_root).training for i in range(0, len(drive), 4)]


def fitted(frames: list[Frame], **options: Any) -> HSD:  # noqa: ANN401
    encoder = HSD(12, steps=80, batch=512, **options)
    encoder.fit(frames)
    return encoder


@pytest.fixture(scope="module")
def ordered(frames: list[Frame]) -> HSD:
    return fitted(frames)


@pytest.fixture(scope="module")
def unordered(frames: list[Frame]) -> HSD:
    """The same without maps, so that its units are the atoms."""
    return fitted(frames, topology=False)


def spectra(pictures: Floats) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of each picture's power spectrum, how oriented it is (0..1), and its share in 0.04..0.35 cycles/px."""
    power = np.abs(np.fft.fft2(pictures, (64, 64))) ** 2
    fv, fu = np.fft.fftfreq(64)[:, None], np.fft.fftfreq(64)
    # Angles are doubled, since a grating and its opposite are one orientation.
    direction, frequency = np.exp(2j * np.arctan2(fv, fu)), np.hypot(fv, fu)
    total = power.sum(axis=(1, 2))
    band = (frequency > 0.04) & (frequency < 0.35)
    return np.abs((power * direction).sum(axis=(1, 2))) / total, power[:, band].sum(axis=1) / total


def test_s1_learns_oriented_band_pass_atoms(unordered: HSD) -> None:
    view = unordered._views.view
    noise = unit_length(np.random.default_rng(0).standard_normal((144, view.size), np.float32))
    (oriented, band), (oriented_noise, band_noise) = (
        spectra(view.picture(rows)) for rows in (unordered.layers[0].units, noise)
    )
    assert np.median(oriented) > 0.6 > 5 * np.median(oriented_noise)
    assert np.median(band) > 0.85 > 1.5 * np.median(band_noise)


def test_learned_atoms_explain_unseen_places_better_than_patches_do(frames: list[Frame], unordered: HSD) -> None:
    layer = unordered.layers[0]
    views = finished(unordered._sampling.drawing(unordered._views, frames, np.random.default_rng(0)))
    seen, unseen = (prepared(part, layer.mean) for part in views)
    patches = unit_length(seen[np.random.default_rng(0).integers(len(seen), size=144)])
    rates = [
        reconstruction_rate(unseen, phi, pursue(unseen, phi, phi @ phi.T, 10, by_correlation(144)))
        for phi in (layer.units, patches)
    ]
    assert rates[0] > rates[1] + 0.15
    assert unordered.reports[0].atoms.held_out == pytest.approx(rates[0], abs=0.01)


def test_neighbours_on_s1s_map_are_alike(ordered: HSD, unordered: HSD) -> None:
    units, atoms = ordered.layers[0].units.reshape(12, 12, -1), unordered.layers[0].units
    beside = np.concatenate(
        [(units[1:] * units[:-1]).sum(axis=-1).ravel(), (units[:, 1:] * units[:, :-1]).sum(axis=-1).ravel()]
    )
    apart = (units[:6] * units[6:]).sum(axis=-1)
    assert beside.mean() > 0.4
    assert np.abs(apart).mean() < 0.15
    assert topographic_error(atoms, units.reshape(144, -1), 12) < 0.2


def likeness(layer: TopologicalLayer, encoder: HSD, frames: list[Frame], cells: NDArray[np.int64], shift: int) -> float:
    """Mean overlap of S1's pooled codes before and after the picture has moved by `shift` px."""
    rows = np.arange(encoder.points)
    matches = []
    for frame in frames:
        points = encoder._views.points(frame)
        codes = [
            max_pool(layer.code(prepared(encoder._views.cut(seen, points), layer.mean)), cells)
            for seen in (frame, np.roll(frame, shift, axis=1))
        ]
        matches.append(match_pairs(codes[0], codes[1], rows, rows))
    return float(np.mean(matches))


@pytest.mark.parametrize("shift", [1, 2, 3])
def test_pooling_makes_codes_stabler_under_small_shifts(ordered: HSD, frames: list[Frame], shift: int) -> None:
    layer, few = ordered.layers[0], frames[::12]
    pooled, apart = layer.cells, np.arange(144)
    shuffled = np.random.default_rng(0).permutation(layer.cells)
    by_map, unpooled, by_chance = (likeness(layer, ordered, few, cells, shift) for cells in (pooled, apart, shuffled))
    assert by_map > unpooled + 0.08
    # Half of it is owed to the map: windows of units that are not alike help less.
    assert by_map > by_chance + 0.04
