"""The claims with their verdicts, written for people: terminal, Markdown and LaTeX."""

from __future__ import annotations

from math import isnan

import pandas as pd
from rich import box
from rich.console import Group
from rich.table import Table
from rich.text import Text

from vprbench.claims.evaluate import count_verdicts
from vprbench.claims.model import load_claims
from vprbench.claims.rules import NOT_SUPPORTED, RULES, SUPPORTED
from vprbench.tables.formats import LATEX, MARKDOWN

__all__ = ["HEADS", "claim_lines", "counted", "to_latex", "to_markdown", "to_terminal"]

HEADS = ("claim", "paper", "ours", "interval", "unit", "verdict", "measured on", "note")
_STYLES = {SUPPORTED: "green", NOT_SUPPORTED: "red"}


def counted(table: pd.DataFrame) -> str:
    """How many claims got each verdict, in a sentence."""
    counts = ", ".join(f"{count} {verdict}" for verdict, count in count_verdicts(table).items())
    return f"{len(table)} claims: {counts}."


def claim_lines(table: pd.DataFrame) -> list[tuple[str, ...]]:
    """The texts of each row, under `HEADS`; what there is no number for is a dash."""
    return [
        (
            f"{row['claim']} [{row['where']}]",
            _number(row["paper"]),
            _number(row["ours"]),
            _interval(row["low"], row["high"]),
            str(row["unit"]),
            str(row["verdict"]),
            _text(row["measured_on"]),
            _text(row["note"]),
        )
        for row in table.to_dict("records")
    ]


def to_terminal(table: pd.DataFrame) -> Group:
    """A table that wraps; supported claims green, the others that were tested red."""
    drawn = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for head in HEADS:
        figure = head in ("paper", "ours", "interval")
        drawn.add_column(head, justify="right" if figure else "left", no_wrap=figure)
    for line in claim_lines(table):
        style = _STYLES.get(line[5], "dim")
        drawn.add_row(*(Text(text, style if head == "verdict" else "") for head, text in zip(HEADS, line, strict=True)))
    said = (*RULES, "What the notes tell you to see is printed by --format markdown.")
    return Group(drawn, *(Text(rule, "dim") for rule in said), Text(counted(table), "bold"))


def to_markdown(table: pd.DataFrame) -> str:
    """GitHub-flavoured Markdown, the disclosures below."""
    rule = ["---:" if head in ("paper", "ours", "interval") else "---" for head in HEADS]
    lines = [[text.translate(MARKDOWN) for text in line] for line in (HEADS, *claim_lines(table))]
    rows = "\n".join(f"| {' | '.join(line)} |" for line in (lines[0], rule, *lines[1:]))
    said = "\n".join(f"- {rule.translate(MARKDOWN)}" for rule in RULES)
    found = "\n".join(f"- **{entry.id}**: {entry.text.translate(MARKDOWN)}" for entry in load_claims().disclosures)
    return f"{rows}\n\n{counted(table)}\n\nHow to read the verdicts:\n\n{said}\n\nDisclosures:\n\n{found}\n"


def to_latex(table: pd.DataFrame) -> str:
    """A LaTeX table over several pages; it needs the packages booktabs and longtable."""
    heads, *lines = (
        " & ".join(text.translate(LATEX) for text in line) + r" \\" for line in (HEADS, *claim_lines(table))
    )
    caption = f"{counted(table)} {' '.join(RULES)}".translate(LATEX)
    parts = [
        r"\begin{longtable}{p{.2\linewidth}rrrlp{.1\linewidth}p{.14\linewidth}p{.2\linewidth}}",
        rf"\caption{{{caption}}} \\",
        r"\toprule",
        heads,
        r"\midrule",
        r"\endhead",
        *lines,
        r"\bottomrule",
        r"\end{longtable}",
    ]
    return "\n".join(parts) + "\n"


def _text(value: object) -> str:
    """A text; a dash where there is none, which a CSV gives back as NaN."""
    return value if isinstance(value, str) and value else "-"


def _interval(low: float, high: float) -> str:
    """Both ends; a dash where there is none, or where the value is exact."""
    return "-" if isnan(low) or low == high else f"{_number(low)} to {_number(high)}"


def _number(value: float) -> str:
    return "-" if isnan(value) else f"{value:.4g}"
