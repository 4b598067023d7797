from __future__ import annotations

import numpy as np
import pytest
from matplotlib.image import AxesImage

from vprbench.figures.style import house_style, new_figure
from vprbench.figures.tiles import draw_tiles, tiled


def pictures(count: int, side: int) -> np.ndarray:
    return np.random.default_rng(count).standard_normal((count, side, side)).astype(np.float32)


@pytest.mark.parametrize(("count", "side", "group"), [(9, 5, 1), (16, 4, 2), (25, 3, 2), (4, 1, 1), (36, 2, 3)])
def test_each_tile_stands_at_its_place_and_gaps_are_blank(count: int, side: int, group: int) -> None:
    given = pictures(count, side)
    whole, per_row = tiled(given, group), int(count**0.5)
    for unit in range(count):
        # Walk there: a pixel after each tile, three more after each whole group.
        top, left = (
            sum(side + (4 if group > 1 and (tile + 1) % group == 0 else 1) for tile in range(place))
            for place in divmod(unit, per_row)
        )
        np.testing.assert_array_equal(whole[top : top + side, left : left + side], given[unit])
    assert np.isfinite(whole).sum() == given.size


def test_two_by_two_by_hand() -> None:
    nan = np.nan
    expected = [[1, nan, 2], [nan, nan, nan], [3, nan, 4]]
    np.testing.assert_array_equal(tiled(np.array([1.0, 2, 3, 4]).reshape(4, 1, 1)), expected)


def test_zero_is_mid_grey_and_beyond_the_reach_is_black_or_white() -> None:
    with house_style():
        axes = new_figure(2.0, 2.0).add_subplot()
        draw_tiles(axes, np.array([-9.0, -2, 0, 1]).reshape(4, 1, 1), reach=2.0)
    (image,) = axes.get_images()
    assert isinstance(image, AxesImage)
    drawn = image.to_rgba(np.asarray(image.get_array()))
    np.testing.assert_allclose(drawn[::2, ::2, 0].ravel(), [0, 0, 0.5, 0.75], atol=0.005)
    assert (drawn[1] == 0).all()
