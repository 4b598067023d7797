"""How far, in metres or frames, the answers lie from the truth."""

from __future__ import annotations

from vprbench.columns import length_unit
from vprbench.figures.curves import error_distribution
from vprbench.report.markup import paragraph
from vprbench.report.material import Material
from vprbench.report.section import Drawing, Section, Sheet
from vprbench.tables import make_table

__all__ = ["errors_in_metres"]

TITLE = "How far off are the answers?"


def errors_in_metres(material: Material) -> Section:
    """The cumulative distribution of the error, and its median."""
    table = Sheet("error-median-by-distance", make_table(material.rows, metric="error_median_m"))
    if not material.runs:
        return Section(TITLE, paragraph("The curves are left out: no trace could be read."), (table,))
    unit = length_unit(material.rows)
    so_many = {"m": "metres"}.get(unit, unit)
    caption = (
        f"Share of all queries whose answered place was learned within so many {so_many} of the query (logarithmic; "
        f"shorter errors are drawn at 0.1 {unit}). A line that ends below 1 belongs to an agent that did not always "
        "answer. Dotted: half the sampling distance, which the error of a right answer may well reach."
    )
    alt = f"Cumulative distributions of the error in {so_many} of {', '.join(material.agents)}."
    figure = error_distribution(material.runs, material.colours, unit)
    return Section(TITLE, tables=(table,), figures=(Drawing("error-metres", figure, alt, caption),))
