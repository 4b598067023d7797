"""Every texture of a street, and under which number each kind of thing finds its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vprbench.street.facades import paint_house
from vprbench.street.parameters import Environment
from vprbench.street.plants import paint_bush, paint_conifer, paint_hedge, paint_tree
from vprbench.street.surroundings import paint_ground_strip, paint_lamp, paint_mark, paint_sign, paint_sky_round
from vprbench.street.texture import Image, Skins, stack_skins
from vprbench.street.vehicles import paint_car

__all__ = ["Wardrobe", "paint_wardrobe"]

# How many models of each kind a street has.
_HOUSES, _TREES, _CONIFERS, _BUSHES, _HEDGES, _SIGNS, _MARKS = 12, 4, 2, 3, 2, 6, 6
_PAINTS = (0.04, 0.1, 0.22, 0.4, 0.6, 0.8)


@dataclass(frozen=True)
class Wardrobe:
    """All textures, and the first texture of every model of each kind."""

    skins: Skins
    models: Mapping[str, tuple[int, ...]]


def paint_wardrobe(environment: Environment, seed: int) -> Wardrobe:
    """The textures of one street; two skies, one for each drive."""
    rng = np.random.default_rng([seed, 3])
    painted: dict[str, list[list[Image]]] = {
        "house": [paint_house(rng) for _ in range(_HOUSES)],
        "tree": [[paint_tree(rng)] for _ in range(_TREES)],
        "conifer": [[paint_conifer(rng)] for _ in range(_CONIFERS)],
        "bush": [[paint_bush(rng)] for _ in range(_BUSHES)],
        "hedge": [[hedge := paint_hedge(rng), hedge] for _ in range(_HEDGES)],
        "car": [paint_car(rng, paint) for paint in _PAINTS],
        "lamp": [[paint_lamp(rng)]],
        "sign": [[paint_sign(rng)] for _ in range(_SIGNS)],
        "mark": [[paint_mark(rng)] for _ in range(_MARKS)],
        "ground": [[paint_ground_strip(rng, environment)]],
        "sky": [[paint_sky_round(rng)] for _ in range(2)],
    }
    images: list[Image] = []
    models: dict[str, tuple[int, ...]] = {}
    for kind, variants in painted.items():
        starts = []
        for surfaces in variants:
            starts.append(len(images))
            images.extend(surfaces)
        models[kind] = tuple(starts)
    return Wardrobe(stack_skins(images), models)
