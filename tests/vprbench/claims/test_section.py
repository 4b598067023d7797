"""The claims as a section of a report."""

from __future__ import annotations

import io

import pandas as pd
import pytest

from vprbench.claims import VERDICTS
from vprbench.claims.evaluate import COLUMNS
from vprbench.report.material import Material, Question
from vprbench.report.sections.appendices import appendices
from vprbench.report.sections.claims import claims

ROW = {
    "id": "size",
    "where": "table of costs",
    "claim": "Is <b>small</b>",
    "paper": 36.0,
    "ours": 35.0,
    "low": 34.0,
    "high": 36.5,
    "unit": "numbers",
    "verdict": VERDICTS[0],
    "measured_on": "fit.csv",
    "note": "",
}


def material(**tables: pd.DataFrame) -> Material:
    return Material("auc-hsd", pd.DataFrame(), Question("", {}), [], {}, {}, {}, tables)


@pytest.fixture
def stored() -> pd.DataFrame:
    """The table as it comes back from a CSV, where empty texts become NaN."""
    untested = {**ROW, "verdict": VERDICTS[2], "ours": None, "low": None, "high": None, "measured_on": ""}
    return pd.read_csv(io.StringIO(pd.DataFrame([ROW, untested], columns=list(COLUMNS)).to_csv(index=False)))


def test_claims_have_a_section_of_their_own(stored: pd.DataFrame) -> None:
    section = claims(material(claims=stored))
    assert section is not None
    for text in ("Is &lt;b&gt;small&lt;/b&gt;", ">34 to 36.5<", "<strong>supported</strong>", "no-k1-1"):
        assert text in section.html
    assert "2 claims: 1 supported, 0 not supported, 1 not testable on the data present." in section.html
    assert "nan" not in section.html
    assert appendices(material(claims=stored)) is None


def test_other_tables_are_no_claims(stored: pd.DataFrame) -> None:
    assert claims(material(fit=stored)) is None
    assert appendices(material(fit=stored)) is not None


def test_a_table_that_lacks_a_column_is_left_out(stored: pd.DataFrame) -> None:
    section = claims(material(claims=stored.drop(columns="verdict")))
    assert section is not None
    assert "Left out: auc-hsd.claims.csv has no column verdict." in section.html
