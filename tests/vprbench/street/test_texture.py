"""Filtered textures, against the averages they stand for."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.errors import ConfigError
from vprbench.street.pixels import no_pixels
from vprbench.street.texture import Skins, choose_level, sample, stack_skins

unit = st.floats(0.0, 1.0)
SIDE = 16


def skins(luma: np.ndarray, alpha: float = 1.0) -> Skins:
    return stack_skins([np.stack([luma * alpha, np.full_like(luma, alpha)], axis=-1).astype(np.float32)])


def look(texture: Skins, u: float, v: float, du: float, dv: float) -> tuple[float, float]:
    """Luma and alpha at (u, v) of the only texture, seen in pixels of some size."""
    return see(texture, 0, u, v, du, dv)


def see(texture: Skins, number: int, u: float, v: float, du: float, dv: float) -> tuple[float, float]:
    skin, pixels = texture.table[number], no_pixels()
    pixels.first[0], pixels.wide[0], pixels.high[0] = choose_level(skin, du, dv)
    pixels.u[0], pixels.v[0] = u, v
    sample(texture.texels, skin, pixels, 1)
    return float(pixels.luma[0]), float(pixels.alpha[0])


RAMP = np.tile((np.arange(SIDE) + 0.5) / SIDE, (SIDE, 1))
NOISE = np.random.default_rng(0).random((SIDE, SIDE))


@given(unit, unit, unit, unit)
def test_a_plain_surface_looks_the_same_at_any_distance(u: float, v: float, du: float, dv: float) -> None:
    luma, alpha = look(skins(np.full((SIDE, SIDE), 0.4)), u, v, du, dv)
    assert luma == pytest.approx(102)
    assert alpha == pytest.approx(255)


@given(st.floats(0.5 / SIDE, 1 - 0.5 / SIDE), unit)
def test_a_near_ramp_is_followed_within_rounding(u: float, v: float) -> None:
    assert look(skins(RAMP), u, v, 0.0, 0.0)[0] == pytest.approx(255 * u, abs=0.51)


@given(unit, unit)
def test_far_away_only_the_mean_is_left(u: float, v: float) -> None:
    assert look(skins(NOISE), u, v, 1.0, 1.0)[0] == pytest.approx(255 * NOISE.mean(), abs=0.51)


@given(unit, st.integers(0, SIDE - 1))
def test_seen_at_a_slant_only_the_far_direction_is_averaged(u: float, row: int) -> None:
    seen, _ = look(skins(NOISE), u, (row + 0.5) / SIDE, 1.0, 0.0)
    assert seen == pytest.approx(255 * NOISE[row].mean(), abs=0.51)


def test_textures_are_kept_apart() -> None:
    images = [np.full((8, 4 << i, 2), i / 4, np.float32) for i in range(4)]
    stacked = stack_skins(images)
    for i in range(len(images)):
        for footprint in (0.0, 0.3, 1.0):
            luma, _ = see(stacked, i, 1.0, 1.0, footprint, footprint)
            assert luma == pytest.approx(255 * i / 4, abs=0.51)


def test_sides_must_be_powers_of_two() -> None:
    with pytest.raises(ConfigError, match="12x16"):
        stack_skins([np.zeros((16, 12, 2), np.float32)])
