"""What was not measured, or cannot be shown, and why."""

from __future__ import annotations

from vprbench.report.markup import fragment
from vprbench.report.material import Material
from vprbench.report.section import Section

__all__ = ["failures"]


def failures(material: Material) -> Section:
    """Failed cells with their errors, and finished ones that lost their trace."""
    failed = list(material.failed[["cell", "error"]].itertuples(index=False, name=None))
    html = fragment("failures", failed=failed, faults=material.faults, cells=len(material.rows), name=material.name)
    return Section("What failed", html)
