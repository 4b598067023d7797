"""Drawings of what HSD has learned: the maps of S1 and S2 as pictures, and how often each unit is used."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float32

from vprbench.figures.style import COLOURS, GREY, WIDTH, caption, house_style, new_figure
from vprbench.figures.tiles import draw_tiles
from vprbench_encoders.hsd_patterns import cells_combined, expected_units, preferred_patterns
from vprbench_encoders.layers import LayerReport, TopologicalLayer
from vprbench_encoders.patches import LocalView

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["DrawnHSD"]

# Black and white of a tile, in root mean squares over its disk: few pixels of a unit lie beyond.
_REACH = 4

_SCALE = f"One grey scale for all: black is -{_REACH}, mid grey 0 and white +{_REACH} root mean squares of a tile."


@dataclass(frozen=True)
class DrawnHSD:
    """What of a fitted HSD is drawn.

    Attributes:
        layers, reports: of the encoder.
        view: whose pixels the units of S1 weigh.
        pool: rows and columns of a pooling window.
        ordered: whether units that are neighbours were made alike.
    """

    layers: Sequence[TopologicalLayer]
    reports: Sequence[LayerReport]
    view: LocalView
    pool: int
    ordered: bool

    def figures(self) -> dict[str, Figure]:
        """Every drawing, by file stem: "s1-units", "usage", and where there is a second layer "s2-patterns"."""
        drawn = {"s1-units": self.units()}
        if len(self.layers) > 1:
            drawn["s2-patterns"] = self.patterns()
        return {**drawn, "usage": self.usage()}

    def units(self) -> Figure:
        """S1's units as a map of tiles."""
        view, units = self.view, self.layers[0].units
        return self._map(
            units,
            f"What the {len(units)} units of S1 look for",
            f"Each disk is one unit: how it weighs the {view.side} x {view.side} pixels of a local view, "
            f"which stand for {view.window} x {view.window} pixels of the frame.",
            "C1",
        )

    def patterns(self) -> Figure:
        """S2's preferred patterns as a map of tiles."""
        first, second = self.layers
        patterns = preferred_patterns(second.units, expected_units(first.units, self.reports[0].usage, first.cells))
        return self._map(
            patterns,
            f"What the {len(patterns)} units of S2 look for",
            "Each disk is the local view that one unit answers to best: the cells of C1 that it weighs positively, "
            "each drawn as the mean of the units of S1 pooled there, weighted by how often they are used. "
            f"The median unit combines {np.median(cells_combined(second.units)):.1f} cells.",
            "C2",
        )

    def usage(self) -> Figure:
        """How often each unit of each layer is used, in order of use and on its map."""
        with house_style():
            figure = new_figure(2.35 * len(self.reports) + 0.5)
            figure.suptitle("How often each unit is used", x=0.01, ha="left")
            for number, (row, report) in enumerate(zip(_rows(figure, len(self.reports)), self.reports, strict=True), 1):
                _draw_usage(row, f"S{number}", 100 * report.usage, report.entropy)
            caption(
                figure,
                "Left: the share of training views in whose code a unit takes part, the most used unit first; dashed, "
                "the mean. Right: the same on the map. Entropy is that of the units' shares of all uses: 1 where all "
                "are used alike, 0 where one alone is used.",
            )
        return figure

    def _map(self, vectors: Float32[np.ndarray, "units size"], title: str, tile: str, pooled: str) -> Figure:
        pictures = np.where(self.view.disk, self.view.picture(vectors), np.nan)
        with house_style():
            figure = new_figure(WIDTH + 0.85)
            figure.suptitle(title, x=0.01, ha="left")
            draw_tiles(figure.add_subplot(), pictures, _REACH / self.view.size**0.5, self.pool)
            caption(figure, " ".join([tile, _SCALE, *self._order(pooled)]))
        return figure

    def _order(self, pooled: str) -> Iterator[str]:
        """What it means where a tile stands."""
        yield "Neighbours were ordered to be alike." if self.ordered else "Tiles stand in the order of their learning."
        if self.pool > 1:
            yield f"Those that stand together, {self.pool} x {self.pool}, are pooled into one cell of {pooled}."


def _rows(figure: Figure, count: int) -> list[tuple[Axes, Axes]]:
    axes = figure.subplots(count, 2, squeeze=False, width_ratios=[1.9, 1])
    return [(left, right) for left, right in axes]


def _draw_usage(row: tuple[Axes, Axes], name: str, percent: Float32[np.ndarray, " units"], entropy: float) -> None:
    bars, heat = row
    bars.stairs(np.sort(percent)[::-1], fill=True, color=COLOURS[0])
    bars.axhline(percent.mean(), color=GREY, linestyle="--", linewidth=0.8)
    bars.set(xlim=(0, len(percent)), xlabel=f"units of {name}, most used first", ylabel="share of views, %")
    unused = int((percent == 0).sum())
    bars.set_title(f"{name}: entropy {entropy:.3f}, {unused} of {len(percent)} never used")
    side = round(len(percent) ** 0.5)
    image = heat.imshow(percent.reshape(side, side), cmap="Blues", vmin=0)
    heat.set(xticks=[], yticks=[], title=f"{name}'s map")
    heat.spines[:].set_visible(False)
    heat.figure.colorbar(image, ax=heat, label="share of views, %", shrink=0.9)
