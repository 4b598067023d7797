"""The paper's claims beside what was measured, where NAME.claims.csv (`vprbench claims --format csv`) lies there."""

from __future__ import annotations

from vprbench.claims import RULES, load_claims
from vprbench.claims.evaluate import COLUMNS
from vprbench.claims.formats import HEADS, claim_lines, counted
from vprbench.report.markup import fragment, paragraph
from vprbench.report.material import Material
from vprbench.report.section import Section

__all__ = ["LABEL", "claims"]

# What the file is called beside the results: NAME.LABEL.csv.
LABEL = "claims"
TITLE = "What of the paper holds?"


def claims(material: Material) -> Section | None:
    """Every claim with its verdict, and below them the rules and where the paper contradicts itself."""
    table = material.appendices.get(LABEL)
    if table is None:
        return None
    if missing := [name for name in COLUMNS if name not in table]:
        return Section(TITLE, paragraph(f"Left out: {material.name}.{LABEL}.csv has no column {missing[0]}."))
    rows = [dict(zip(HEADS, line, strict=True)) for line in claim_lines(table)]
    said = {"counted": counted(table), "rules": RULES, "disclosures": load_claims().disclosures}
    return Section(TITLE, fragment("claims", rows=rows, **said))
