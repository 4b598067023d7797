"""Whatever other tables lie beside the results: how encoders fitted, timings."""

from __future__ import annotations

import pandas as pd

from vprbench.report.markup import fragment
from vprbench.report.material import Material
from vprbench.report.section import Section
from vprbench.report.sections.claims import LABEL

__all__ = ["appendices"]


def appendices(material: Material) -> Section | None:
    """Each NAME.LABEL.csv as it stands; the claims have a section of their own."""
    others = {label: frame for label, frame in material.appendices.items() if label != LABEL}
    if not others:
        return None
    tables = [_plain(material.name, label, frame) for label, frame in others.items()]
    return Section("Beside these results", fragment("appendices", tables=tables))


def _plain(name: str, label: str, frame: pd.DataFrame) -> dict[str, object]:
    """A table as text, with a note of which columns are numbers."""
    numbers = [pd.api.types.is_numeric_dtype(frame[column]) for column in frame]
    rows = [[_shown(value) for value in line] for line in frame.itertuples(index=False)]
    return {"file": f"{name}.{label}.csv", "heads": list(map(str, frame.columns)), "numbers": numbers, "rows": rows}


def _shown(value: object) -> str:
    if isinstance(value, float):
        return "" if value != value else f"{value:.6g}"
    return str(value)
