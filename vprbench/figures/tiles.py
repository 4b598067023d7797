"""Maps of small pictures: what each unit of a square map stands for, tile beside tile."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Float32

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw_tiles", "tiled"]


def tiled(pictures: Float[np.ndarray, "n side side"], group: int = 1) -> Float32[np.ndarray, "height width"]:
    """One picture of a square map of pictures, row after row of the map; NaN in the gaps between them.

    Args:
        pictures: as many as the map has places.
        group: rows and columns of tiles that stand together, one pixel apart; groups are four pixels apart.
    """
    per_row, side = round(len(pictures) ** 0.5), pictures.shape[1]
    starts = np.arange(per_row) * (side + 1) + np.arange(per_row) // group * (3 if group > 1 else 0)
    along = (starts[:, None] + np.arange(side)).ravel()
    whole = np.full((along[-1] + 1, along[-1] + 1), np.nan, np.float32)
    whole[np.ix_(along, along)] = pictures.reshape(per_row, per_row, side, side).swapaxes(1, 2).reshape(len(along), -1)
    return whole


def draw_tiles(axes: Axes, pictures: Float[np.ndarray, "n side side"], reach: float, group: int = 1) -> None:
    """Draw a map of pictures in grey: black at -reach and below, white at reach and above, NaN left blank."""
    axes.imshow(tiled(pictures, group), cmap="gray", vmin=-reach, vmax=reach)
    axes.set_axis_off()
