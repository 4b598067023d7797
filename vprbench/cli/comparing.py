"""`vprbench compare`: which agents differ, by the answers that a sweep left."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pandas as pd
from rich.console import Console
from rich.table import Table
from rich.text import Text

from vprbench.bootstrap import BLOCK_M, LEVEL, RESAMPLES
from vprbench.errors import ConfigError, nearest
from vprbench.paired import VERDICTS, compare
from vprbench.results import ResultTable, read_table
from vprbench.tables.formats import LABELS, LATEX, MARKDOWN, WIDEST

__all__ = ["compare_command"]

HEADS = ("agent", "reference", "difference", f"{100 * LEVEL:g} % interval", "cells", "queries", "seeds", "verdict")
RIGHT = HEADS[2:7]

NOTES = (
    f"{100 * LEVEL:g} % intervals of {RESAMPLES} paired resamples of blocks of {BLOCK_M:g} m and of seeds",
    "each pair by itself: of 20 pairs of equal agents about one is found to differ by chance",
)


def compare_command(results: Path, metric: str, reference: str | None, format: str) -> None:
    """Print the differences between agents, each with its interval and what it shows."""
    writers: dict[str, Callable[[pd.DataFrame], str]] = {"markdown": _markdown, "latex": _latex, "csv": _csv}
    if format not in {*writers, "terminal"}:
        raise ConfigError(f"--format {format!r}: {nearest(format, [*writers, 'terminal'])}")
    read_table(results)  # says what is wrong where there is no table
    pairs = compare(ResultTable(results.parent, results.stem), metric, reference=reference)
    # Better a line that runs on than a figure cut in two.
    console = Console(width=WIDEST)
    if format == "terminal":
        _print(pairs, console)
    else:
        console.out(writers[format](pairs), highlight=False, end="")


def _title(pairs: pd.DataFrame) -> str:
    """What is compared, by which rule, in which unit."""
    metric = str(pairs["metric"].iloc[0])
    rule = "metric rule" if metric.endswith("_metric") else "place-field rule"
    return f"{LABELS[metric.removesuffix('_metric')]} ({rule}): paired differences in percentage points"


def _lines(pairs: pd.DataFrame) -> list[tuple[str, ...]]:
    """The texts of each row."""
    return [
        (
            str(row["agent"]),
            str(row["reference"]),
            f"{100 * row['difference']:+.1f}",
            "-" if pd.isna(row["low"]) else f"{100 * row['low']:+.1f} to {100 * row['high']:+.1f}",
            str(row["cells"]),
            str(row["queries"]),
            f"{row['seeds']}, {row['reference_seeds']}",
            str(row["verdict"]),
        )
        for row in pairs.to_dict("records")
    ]


def _print(pairs: pd.DataFrame, console: Console) -> None:
    """A table for the terminal; what differs stands out."""
    drawn = Table(title=Text(_title(pairs), "bold"), title_justify="left")
    for head in HEADS:
        drawn.add_column(head, justify="right" if head in RIGHT else "left")
    for line in _lines(pairs):
        drawn.add_row(*map(Text, line), style="bold" if line[-1] in VERDICTS[:2] else "")
    console.print(drawn, *(Text(note, "dim") for note in NOTES), sep="\n")


def _markdown(pairs: pd.DataFrame) -> str:
    """GitHub-flavoured Markdown."""
    rule = ["---:" if head in RIGHT else "---" for head in HEADS]
    lines = [[text.translate(MARKDOWN) for text in line] for line in (HEADS, *_lines(pairs))]
    rows = "\n".join(f"| {' | '.join(line)} |" for line in (lines[0], rule, *lines[1:]))
    return f"**{_title(pairs).translate(MARKDOWN)}**\n\n{rows}\n\n{'; '.join(NOTES).translate(MARKDOWN)}.\n"


def _latex(pairs: pd.DataFrame) -> str:
    """A LaTeX float; it needs the package booktabs."""
    heads, *lines = (" & ".join(text.translate(LATEX) for text in line) + r" \\" for line in (HEADS, *_lines(pairs)))
    columns = "".join("r" if head in RIGHT else "l" for head in HEADS)
    caption = f"{_title(pairs)}. {'; '.join(NOTES)}.".translate(LATEX)
    parts = [r"\begin{table}", r"\centering", rf"\caption{{{caption}}}", rf"\begin{{tabular}}{{{columns}}}"]
    parts += [r"\toprule", heads, r"\midrule", *lines, r"\bottomrule", r"\end{tabular}", r"\end{table}"]
    return "\n".join(parts) + "\n"


def _csv(pairs: pd.DataFrame) -> str:
    """Tidy CSV with the exact figures, in the units of the results."""
    return pairs.to_csv(index=False, lineterminator="\n")
