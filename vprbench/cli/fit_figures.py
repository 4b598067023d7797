"""The measures of several fits side by side, as figures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from vprbench.figures.files import save_figure
from vprbench.figures.measures import measure_bars
from vprbench.fit_table import Fit, as_frame

__all__ = ["draw_measures", "families"]


def draw_measures(fits: Sequence[Fit], folder: Path) -> None:
    """Bars of each family of measures, as FOLDER/measure-FAMILY.png and .svg."""
    names = dict.fromkeys(name for fit in fits for name in (*fit.measures, *fit.seconds))
    for family, measures in families(names).items():
        figure = measure_bars(as_frame(fits), measures, axis=family.replace("_", " "))
        save_figure(figure, folder, f"measure-{family}")


def families(names: Iterable[str]) -> dict[str, list[str]]:
    """Measures that share an axis: alike but for the layer that they begin with (s1_) and the ending _held_out."""
    found: dict[str, list[str]] = {}
    for name in names:
        family = re.sub(r"^[a-z]\d+_", "", name).removesuffix("_held_out")
        found.setdefault("seconds" if family.endswith("_seconds") else family, []).append(name)
    return found
