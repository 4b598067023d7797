"""Precision-recall curves."""

from __future__ import annotations

from vprbench.figures.curves import precision_recall
from vprbench.report.markup import paragraph
from vprbench.report.material import Material
from vprbench.report.section import Drawing, Section

__all__ = ["precision"]

TITLE = "Can the confidence be trusted?"


def precision(material: Material) -> Section:
    """One panel a route and sampling distance."""
    if not material.runs:
        return Section(TITLE, paragraph("Left out: no trace of a finished cell could be read."))
    caption = (
        "Precision over recall, relative to all queries, as ever less confident answers are accepted; a thin line a "
        "run. The dot at the end of a line is the top-1 accuracy, the area under the line the AUC over all queries. "
        "Stretched until every line ends at recall 1, the same lines have the AUC below them."
    )
    alt = f"Precision-recall curves of {', '.join(material.agents)}, a panel for each route and sampling distance."
    figure = precision_recall(material.runs, material.colours)
    return Section(TITLE, figures=(Drawing("precision-recall", figure, alt, caption),))
