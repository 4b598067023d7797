"""Maps of the roads."""

from __future__ import annotations

from vprbench.figures.maps import route_maps
from vprbench.figures.panels import distinct
from vprbench.report.markup import paragraph
from vprbench.report.material import Material
from vprbench.report.section import Drawing, Section

__all__ = ["maps"]

TITLE = "Where on the road?"


def maps(material: Material) -> Section:
    """One figure a route."""
    if not material.runs:
        return Section(TITLE, paragraph("Left out: no trace of a finished cell could be read."))
    drawings = tuple(_drawing(material, route) for route in distinct(run.route for run in material.runs))
    text = paragraph(
        "Every query of the second drive where it was asked. Right means the place-field rule: the answered place won "
        "the first drive's record phase beside the query. Right answers are drawn on the road, the others in lanes "
        "beside it, so that none hides another."
    )
    return Section(TITLE, text, figures=drawings)


def _drawing(material: Material, route: str) -> Drawing:
    """The maps of one route."""
    runs = [run for run in material.first_runs if run.route == route]
    road = material.routes.get(route)
    learn = "Grey: the first drive." if road else "The first drive is not drawn: its data are not here."
    seeds = " Of several seeds the first is shown." if len(runs) < _runs_on(material, route) else ""
    figure = route_maps(runs, road.learn.positions if road else None)
    alt = f"Maps of {route}, one for each agent and sampling distance, with right, near and wrong answers marked."
    return Drawing(f"map-{route}", figure, alt, f"{route}. {learn}{seeds}")


def _runs_on(material: Material, route: str) -> int:
    return sum(run.route == route for run in material.runs)
