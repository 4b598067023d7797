"""The sections of a report, in their order: each a pure function of the material, None where it has nothing to say.

A section of your own is a module with such a function, and its line in `SECTIONS`.
"""

from __future__ import annotations

from collections.abc import Callable

from vprbench.report.material import Material
from vprbench.report.section import Section
from vprbench.report.sections.appendices import appendices
from vprbench.report.sections.claims import claims
from vprbench.report.sections.differences import differences
from vprbench.report.sections.distances import by_distance
from vprbench.report.sections.errors import errors_in_metres
from vprbench.report.sections.failures import failures
from vprbench.report.sections.frames import frames
from vprbench.report.sections.maps import maps
from vprbench.report.sections.precision import precision
from vprbench.report.sections.provenance import provenance
from vprbench.report.sections.question import question
from vprbench.report.sections.repeat import repeat
from vprbench.report.sections.scores import scores

__all__ = ["SECTIONS"]

SECTIONS: tuple[Callable[[Material], Section | None], ...] = (
    question,
    scores,
    differences,
    by_distance,
    precision,
    errors_in_metres,
    maps,
    frames,
    claims,
    appendices,
    failures,
    provenance,
    repeat,
)
