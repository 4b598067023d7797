"""The scores: one table a metric."""

from __future__ import annotations

from vprbench.report.markup import fragment
from vprbench.report.material import Material
from vprbench.report.section import Section, Sheet
from vprbench.tables import make_table

__all__ = ["scores"]

METRICS = ("auc", "auc_all", "accuracy")


def scores(material: Material) -> Section:
    """Each metric by sampling distance and, of several routes, by route."""
    axes = {"distance": "sampling_distance_m", "route": "route"}
    if material.rows["route"].nunique() == 1:
        del axes["route"]
    sheets = tuple(
        Sheet(f"{metric}-by-{label}", make_table(material.rows, columns=axis, metric=metric))
        for metric in METRICS
        for label, axis in axes.items()
    )
    return Section("Scores", fragment("scores"), tables=sheets)
