from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch

from vprbench.checks.samples import textured_frame
from vprbench.errors import PhaseError
from vprbench.protocols import Drawn
from vprbench_encoders.homeostasis import usage_entropy
from vprbench_encoders.hsd import HSD
from vprbench_encoders.hsd_patterns import expected_units, preferred_patterns
from vprbench_encoders.layers import prepared


def fitted(**options: Any) -> HSD:  # noqa: ANN401
    encoder = HSD(**{"size": 6, "map_size": 7, "steps": 5, "epochs": 5, "points": 12, **options})
    encoder.fit([textured_frame(seed) for seed in (200, 201, 202)])
    return encoder


@pytest.fixture(scope="module")
def encoder() -> HSD:
    return fitted()


@pytest.fixture(scope="module")
def figures(encoder: HSD) -> dict[str, Figure]:
    return encoder.figures()


def words(figure: Figure) -> str:
    """All that is written on a figure outside its axes, on one line."""
    return " ".join(" ".join(text.get_text() for text in figure.texts).split())


def picture(figure: Figure, axes: int = 0) -> np.ndarray:
    (image,) = figure.axes[axes].get_images()
    return np.ma.filled(np.ma.asarray(image.get_array()), np.nan)


def tile(whole: np.ndarray, row: int, column: int, side: int = 27, pool: int = 2) -> np.ndarray:
    top, left = (place * (side + 1) + place // pool * 3 for place in (row, column))
    return whole[top : top + side, left : left + side]


def test_an_encoder_says_what_can_be_drawn(encoder: HSD, figures: dict[str, Figure]) -> None:
    assert isinstance(encoder, Drawn)
    assert list(figures) == ["s1-units", "s2-patterns", "usage"]
    assert list(fitted(signature="c1").figures()) == ["s1-units", "usage"]


def test_before_it_has_learned_there_is_nothing_to_draw() -> None:
    with pytest.raises(PhaseError, match="fit"):
        HSD().figures()


def test_tiles_of_s1_are_its_units_and_blank_beyond_the_disk(encoder: HSD, figures: dict[str, Figure]) -> None:
    whole, view = picture(figures["s1-units"]), encoder._views.view
    for unit in (0, 8, 48):
        drawn = tile(whole, *divmod(unit, 7))
        np.testing.assert_array_equal(drawn[view.disk], encoder.layers[0].units[unit])
        assert np.isnan(drawn[~view.disk]).all()


def test_tiles_of_s2_are_the_patterns_that_its_units_prefer(encoder: HSD, figures: dict[str, Figure]) -> None:
    first, second = encoder.layers
    patterns = preferred_patterns(second.units, expected_units(first.units, encoder.reports[0].usage, first.cells))
    whole, disk = picture(figures["s2-patterns"]), encoder._views.view.disk
    for unit in (0, 13, 48):
        np.testing.assert_array_equal(tile(whole, *divmod(unit, 7))[disk], patterns[unit])


def test_the_grey_scale_is_what_the_caption_says(figures: dict[str, Figure]) -> None:
    for stem in ("s1-units", "s2-patterns"):
        (image,) = figures[stem].axes[0].get_images()
        # Of a tile of length 1, the root mean square follows from its number of pixels.
        pixels = np.isfinite(tile(picture(figures[stem]), 0, 0)).sum()
        np.testing.assert_allclose(image.get_clim(), [-4 / pixels**0.5, 4 / pixels**0.5])
        assert "black is -4, mid grey 0 and white +4 root mean squares" in words(figures[stem])


def test_captions_follow_the_options() -> None:
    plain = fitted(pool=1, topology=False, map_size=None, window=40).figures()["s1-units"]
    assert "20 x 20 pixels of a local view, which stand for 40 x 40" in words(plain)
    assert "in the order of their learning" in words(plain)
    assert "pooled" not in words(plain)


def test_usage_is_drawn_in_order_and_on_the_map(encoder: HSD, figures: dict[str, Figure]) -> None:
    bars = [axes for axes in figures["usage"].axes if axes.get_xlabel()]
    maps = [axes for axes in figures["usage"].axes if axes.get_images()]
    for number, (axes, heat, report) in enumerate(zip(bars, maps, encoder.reports, strict=True), 1):
        (steps,) = (patch for patch in axes.patches if isinstance(patch, StepPatch))
        heights = steps.get_data()[0]
        np.testing.assert_array_equal(heights, np.sort(100 * report.usage)[::-1])
        assert np.asarray(axes.get_lines()[0].get_ydata())[0] == pytest.approx(100 * report.usage.mean())
        (image,) = heat.get_images()
        np.testing.assert_array_equal(image.get_array(), 100 * report.usage.reshape(7, 7))
        unused = int((report.usage == 0).sum())
        assert axes.get_title(loc="left") == (
            f"S{number}: entropy {usage_entropy(report.usage):.3f}, {unused} of 49 never used"
        )


def test_usage_counts_the_views_that_a_unit_takes_part_in() -> None:
    encoder = fitted(signature="c1", copies=1, jitter=0)
    counts, views = np.zeros(49), 0
    for seed in (200, 201, 202):
        frame = textured_frame(seed)
        for view in encoder._views.cut(frame, encoder._views.points(frame)):
            code = encoder.layers[0].code(prepared(view[None], encoder.layers[0].mean))
            counts[sorted(set(code.atoms[code.values != 0]))] += 1
            views += 1
    np.testing.assert_allclose(encoder.reports[0].usage, counts / views, atol=1e-6)
