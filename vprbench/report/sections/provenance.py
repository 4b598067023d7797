"""Where the numbers come from."""

from __future__ import annotations

from collections.abc import Mapping

from vprbench.report.markup import fragment
from vprbench.report.material import Material
from vprbench.report.section import Section

__all__ = ["provenance"]

# Columns of a result table, and what to call them.
FACTS: Mapping[str, str] = {
    "vprbench": "vprbench",
    "commit": "commit",
    "plugins": "plug-ins",
    "python": "Python",
    "libraries": "libraries",
    "seed": "seeds",
    "tolerance_rule": "tolerance",
    "recall_denominator": "recall is relative to",
    "interval_rule": "intervals",
}


def provenance(material: Material) -> Section:
    """Versions, commit, seeds, rules, and the checksum of each route's data."""
    rows = material.rows
    facts = [(label, [str(value) for value in sorted(set(rows[name])) if str(value)]) for name, label in FACTS.items()]
    pairs = material.finished[["route", "data_checksum"]].drop_duplicates()
    sums = list(pairs.itertuples(index=False, name=None))
    altered = any(str(commit).endswith("+") for commit in rows["commit"])
    return Section("Where the numbers come from", fragment("provenance", facts=facts, sums=sums, altered=altered))
