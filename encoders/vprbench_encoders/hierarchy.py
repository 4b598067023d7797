"""A hierarchy of topological sparse layers: each codes what the one below it answers with."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from vprbench_encoders.hsd_store import Learned
from vprbench_encoders.layers import LayerRecipe, LayerReport, TopologicalLayer
from vprbench_encoders.local_views import TrainingViews
from vprbench_encoders.matching_pursuit import Selection
from vprbench_encoders.stepwise import Stage, named

__all__ = ["Hierarchy", "learning", "measures", "restored"]


class Hierarchy(NamedTuple):
    """The layers, the first first, and what each has learned."""

    layers: tuple[TopologicalLayer, ...] = ()
    reports: tuple[LayerReport, ...] = ()


def learning(recipes: Sequence[LayerRecipe], views: TrainingViews, random: np.random.Generator) -> Stage[Hierarchy]:
    """The hierarchy that these views teach, layer by layer: S1 from the views, S2 from C1, which is S1 pooled."""
    learned = Hierarchy()
    inputs, held_out = views
    for number, recipe in enumerate(recipes, 1):
        if learned.layers:
            below = learned.layers[-1]
            inputs = yield from named(f"C{number - 1}", below.pooling(inputs))
            held_out = below.pooled(held_out)
        layer, report = yield from recipe.follow(f"S{number}", inputs, held_out, random)
        learned = Hierarchy((*learned.layers, layer), (*learned.reports, report))
    return learned


def measures(hierarchy: Hierarchy) -> dict[str, float]:
    """`LayerReport.measures` of S1 and of S2, by name, and the size of a signature."""
    found = {
        f"s{number}_{name}": value
        for number, report in enumerate(hierarchy.reports, 1)
        for name, value in report.measures().items()
    }
    return found | {"signature_size": float(hierarchy.layers[-1].size)}


def restored(recipes: Sequence[LayerRecipe], stored: Sequence[Learned], size: int) -> Iterator[TopologicalLayer]:
    """The layers that learned this from views of so many pixels.

    Raises:
        ValueError: it is not what these recipes make.
    """
    for recipe, learned in zip(recipes, stored, strict=True):
        if learned.units.shape != (recipe.side**2, size):
            raise ValueError(learned.units.shape)
        layer = recipe.layer(learned.units, learned.mean, Selection(learned.gain, learned.tables))
        size = layer.size
        yield layer
