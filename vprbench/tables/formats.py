"""A table written for people (terminal, Markdown, LaTeX) and for programs (CSV)."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isnan

import pandas as pd
from rich.console import Console, ConsoleOptions, Group, RenderResult
from rich.table import Table as RichTable
from rich.text import Text

from vprbench.metrics import RECALL_DEPTHS
from vprbench.tables.model import Entry, Table, unit

__all__ = ["notes", "title", "to_csv", "to_latex", "to_markdown", "to_terminal"]

LABELS = {
    "auc": "PR-AUC, recall over the correct top-1s",
    "auc_all": "PR-AUC, recall over all queries",
    "accuracy": "top-1 accuracy",
    "recall_at_100_precision": "recall at 100 % precision, over the correct top-1s",
    "recall_at_100_precision_all": "recall at 100 % precision, over all queries",
    "extended_precision": "extended precision",
    "roc_auc": "ROC-AUC of the confidence",
    **{f"recall_at_{depth}": f"recall@{depth}" for depth in RECALL_DEPTHS},
}
FREE_OF_RULES = {
    "error_mean_m": "mean error",
    "error_median_m": "median error",
    "no_match": "queries without a match",
}
PARTIAL = "†"
LISTED = 5

# Characters: wider than any table, and than any terminal.
WIDEST = 10_000

# Characters that mean something to the format, or that it may not print.
MARKDOWN = str.maketrans({character: f"\\{character}" for character in "\\`*_|<>[]~"})
LATEX = str.maketrans(
    {
        "\\": r"\textbackslash{}",
        "~": r"\textasciitilde{}",
        "^": r"\textasciicircum{}",
        "<": r"\textless{}",
        ">": r"\textgreater{}",
        "|": r"\textbar{}",
        "[": "{[}",  # after a line break it would open an argument
        "±": r"$\pm$",
        "†": r"$^\dagger$",
        **{character: f"\\{character}" for character in "&%$#_{}"},
    }
)


def title(table: Table) -> str:
    """What the table shows, by which rule, in which unit, along which axis."""
    rule = "metric rule" if table.metric.endswith("_metric") else "place-field rule"
    label = LABELS.get(table.metric.removesuffix("_metric"))
    named = f"{label} ({rule})" if label else FREE_OF_RULES.get(table.metric, table.metric)
    symbol = unit(table.metric, table.length).symbol
    return f"{named}{f', in {symbol}' if symbol else ''}, by {_named(table.axes[1])}"


def notes(table: Table) -> list[str]:
    """What a reader must know to read the entries: how many cells, which failed, what the signs mean."""
    entries = [entry for line in table.entries for entry in line]
    listed = ", ".join(table.failed[:LISTED]) + (", ..." if len(table.failed) > LISTED else "")
    said = [f"{table.cells} cells, {len(table.failed)} failed" + (f": {listed}" if listed else "")]
    if any(not isnan(entry.sd) for entry in entries):
        said.append(
            "± standard deviation over routes and distances (of one: over seeds; of the mean: over its entries)"
        )
    if any(not isnan(entry.low) for entry in entries):
        said.append("(low to high) block-bootstrap interval of a single cell")
    if any(entry.best for entry in entries):
        said.append("bold: best agent")
    if any(entry.partial for entry in entries):
        said.append(f"{PARTIAL} some of its cells failed, were not run or have no value: not comparable")
    return said


@dataclass(frozen=True)
class _Unshrunk:
    """A table drawn as wide as its entries are: better a line that runs on than a figure cut in two."""

    drawn: RichTable

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        yield from console.render(self.drawn, options.update(max_width=WIDEST))


def to_terminal(table: Table, *, legend: bool = True) -> Group:
    """The table for a terminal, title above and notes below; print it with `soft_wrap`, lest rich crops it.

    Leave out the legend where the next table has the same.
    """
    drawn = RichTable()
    drawn.add_column(Text(_named(table.axes[0])))
    for column in table.columns:
        drawn.add_column(Text(column), justify="right")
    for head, line in zip(table.rows, table.entries, strict=True):
        drawn.add_row(Text(head), *(_styled(entry, table.metric) for entry in line))
    below = [Text(note, "dim") for note in notes(table)] if legend else []
    return Group(Text(title(table), "bold"), _Unshrunk(drawn), *below)


def to_markdown(table: Table) -> str:
    """The table as GitHub-flavoured Markdown."""
    heads, *lines = _grid(table, MARKDOWN, "**{}**")
    rule = ["---", *("---:" for _ in table.columns)]
    rows = "\n".join(f"| {' | '.join(line)} |" for line in (heads, rule, *lines))
    return f"**{title(table).translate(MARKDOWN)}**\n\n{rows}\n\n{_sentence(table).translate(MARKDOWN)}\n"


def to_latex(table: Table) -> str:
    """The table as a LaTeX float, title and notes in its caption; it needs the package booktabs."""
    heads, *lines = (" & ".join(line) + r" \\" for line in _grid(table, LATEX, r"\textbf{{{}}}"))
    parts = [
        r"\begin{table}",
        r"\centering",
        rf"\caption{{{title(table).translate(LATEX)}. {_sentence(table).translate(LATEX)}}}",
        rf"\begin{{tabular}}{{l{'r' * len(table.columns)}}}",
        r"\toprule",
        heads,
        r"\midrule",
        *lines,
        r"\bottomrule",
        r"\end{tabular}",
        r"\end{table}",
    ]
    return "\n".join(parts) + "\n"


def to_csv(table: Table) -> str:
    """The table as tidy CSV, one row an entry, with the exact figures in the units of the results."""
    tidy = [
        {table.axes[0]: row, table.axes[1]: column, "metric": table.metric, **asdict(entry)}
        for row, line in zip(table.rows, table.entries, strict=True)
        for column, entry in zip(table.columns, line, strict=True)
    ]
    return pd.DataFrame(tidy).to_csv(index=False, lineterminator="\n")


def _named(axis: str) -> str:
    return axis.removesuffix("_m").replace("_", " ")


def _sentence(table: Table) -> str:
    return "; ".join(notes(table)) + "."


def _grid(table: Table, escapes: dict[int, str], bold: str) -> list[list[str]]:
    """Every text of the table, heads included, escaped for a format; the best figures in its bold."""

    def written(entry: Entry) -> str:
        figure, spread, interval = _figures(entry, table.metric)
        rest = f"{spread} {interval}".rstrip().translate(escapes)
        return (bold.format(figure) if entry.best else figure) + rest

    lines = zip(table.rows, table.entries, strict=True)
    return [
        [text.translate(escapes) for text in (_named(table.axes[0]), *table.columns)],
        *([head.translate(escapes), *map(written, line)] for head, line in lines),
    ]


def _styled(entry: Entry, metric: str) -> Text:
    """An entry for the terminal, its interval on a line of its own."""
    figure, spread, interval = _figures(entry, metric)
    return Text.assemble((figure, "bold" if entry.best else ""), spread, (f"\n{interval}".rstrip(), "dim"))


def _figures(entry: Entry, metric: str) -> tuple[str, str, str]:
    """The figure itself, its mark and spread, and its interval."""
    factor, decimals, _ = unit(metric)
    mark = PARTIAL if entry.partial else ""
    if not entry.cells:
        return "-", mark, ""

    def shown(figure: float) -> str:
        return f"{figure * factor:.{decimals}f}"

    spread = "" if isnan(entry.sd) else f" ± {shown(entry.sd)}"
    interval = "" if isnan(entry.low) else f"({shown(entry.low)} to {shown(entry.high)})"
    return shown(entry.mean), mark + spread, interval
