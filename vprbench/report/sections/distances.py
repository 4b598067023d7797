"""Every metric against the sampling distance."""

from __future__ import annotations

from vprbench.figures.sampling import metrics_by_distance
from vprbench.report.markup import paragraph
from vprbench.report.material import Material
from vprbench.report.section import Drawing, Section

__all__ = ["by_distance"]

TITLE = "How densely must places be learned?"
METRICS = {"auc": "AUC", "auc_all": "AUC over all queries", "accuracy": "top-1 accuracy"}


def by_distance(material: Material) -> Section:
    """Lines with interval bands."""
    if material.finished.empty:
        return Section(TITLE, paragraph("Left out: no cell was measured."))
    caption = (
        "Each metric against the distance between places, one line an agent. Bands or bars are 95 % block-bootstrap "
        "intervals over stretches of road; of several seeds the line is the mean, and the band or bar holds "
        "the intervals of all."
    )
    alt = f"Line charts of AUC, AUC over all queries and top-1 accuracy by sampling distance for {_names(material)}."
    figure = metrics_by_distance(material.finished, METRICS, material.colours)
    return Section(TITLE, figures=(Drawing("by-distance", figure, alt, caption),))


def _names(material: Material) -> str:
    return ", ".join(material.agents)
