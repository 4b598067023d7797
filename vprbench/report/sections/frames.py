"""What the camera saw: frames of right, wrong and uncertain answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from vprbench.figures.panels import Run, distinct
from vprbench.figures.sheet import Example, contact_sheet
from vprbench.report.examples import pick_examples
from vprbench.report.markup import fragment
from vprbench.report.material import Material
from vprbench.report.places import place_frames
from vprbench.report.section import Drawing, Section
from vprbench.route import Route

__all__ = ["frames"]

# Sheets: what a reader leafs through, and a page of a few megabytes holds.
_MOST = 10


def frames(material: Material) -> Section:
    """A contact sheet for every route and agent, at the middle sampling distance."""
    middle = material.distances[len(material.distances) // 2]
    runs = [run for run in material.first_runs if run.distance == middle]
    shown = [run for run in runs if run.route in material.routes]
    kept = _few(shown)
    traceless = [] if runs else [f"no trace at {middle:g} m could be read"]
    left_out = [*traceless, *(f"{route}: {why}" for route, (why, _) in material.absent.items())]
    if unshown := [f"{run.agent} on {run.route}" for run in shown if run not in kept]:
        left_out.append(f"{', '.join(unshown)}: a page holds {_MOST} sheets")
    html = fragment("frames", left_out=left_out, distance=f"{middle:g}", any=bool(kept))
    return Section("What the camera saw", html, figures=tuple(_drawing(run, material.routes) for run in kept))


def _few(runs: Sequence[Run]) -> list[Run]:
    """The runs on the first routes, whole routes only, as many as a page holds; of the first route in any case some."""
    kept: list[Run] = []
    for route in distinct(run.route for run in runs):
        group = [run for run in runs if run.route == route]
        if kept and len(kept) + len(group) > _MOST:
            break
        kept += group[:_MOST]
    return kept


def _drawing(run: Run, routes: Mapping[str, Route]) -> Drawing:
    """The sheet of one run."""
    examples = _examples(run, routes[run.route])
    alt = f"Query, retrieved and true frames of {run.agent} on {run.route}: " + "; ".join(
        example.text for example in examples
    )
    caption = f"{run.agent} on {run.route}, a place every {run.distance:g} m."
    return Drawing(f"frames-{run.route}-{run.agent}", contact_sheet(examples), alt, caption, photographic=True)


def _examples(run: Run, route: Route) -> list[Example]:
    """The chosen answers of a run, with their frames."""
    made, trace = place_frames(run.trace, route), run.trace
    nearest = route.visit.nearest
    return [
        Example(
            _said(kind, run, route, index, made),
            bool(trace.correct[index]),
            route.test.frames[index],
            route.learn.frames[made[place]] if (place := int(trace.hypothesis[index])) in made else None,
            route.learn.frames[int(nearest[index])],
        )
        for kind, index in pick_examples(trace)
    ]


def _said(kind: str, run: Run, route: Route, index: int, made: Mapping[int, int]) -> str:
    """Why a query is shown, its frame and answer, confidence and error, in a line."""
    trace, place = run.trace, int(run.trace.hypothesis[index])
    learned = f"frame {route.learn.indices[made[place]]}" if place in made else "a frame that cannot be told"
    verdict = "right" if trace.correct[index] else "near" if trace.correct_metric[index] else "wrong"
    said = f"{kind}: frame {trace.frame[index]} taken for {learned} (place {place})"
    said += f", confidence {trace.confidence[index]:.3f}, {trace.error_m[index]:.1f} m off"
    return said if kind.startswith(verdict) else f"{said}, {verdict}"
