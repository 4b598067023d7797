"""The commands that read what a sweep left: tables, comparisons, claims, reports, scores."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vprbench.cli.arguments import Data, Routes

__all__ = ["claims", "compare", "report", "score", "table"]


def table(
    results: Annotated[Path, typer.Argument(help="The .csv or .parquet of a sweep.")],
    rows: Annotated[str, typer.Option(help="Column of the results to list downwards.")] = "agent",
    columns: Annotated[str, typer.Option(help="Column of the results to list across.")] = "sampling_distance_m",
    metric: Annotated[str, typer.Option(help="Which score; any numeric column.")] = "auc",
    format: Annotated[str, typer.Option(help="terminal, markdown, latex or csv.")] = "terminal",
) -> None:
    """Pivot a result table: means, standard deviations and intervals, the best in bold."""
    from vprbench.cli.reading import table_command

    table_command(results, rows, columns, metric, format)


def compare(
    results: Annotated[Path, typer.Argument(help="The .csv or .parquet of a sweep, its traces beside it.")],
    metric: Annotated[str, typer.Option(help="auc, auc_all or accuracy; with _metric by the metric rule.")] = "auc_all",
    reference: Annotated[str | None, typer.Option(help="The agent to compare with. Default: each with each.")] = None,
    format: Annotated[str, typer.Option(help="terminal, markdown, latex or csv.")] = "terminal",
) -> None:
    """Say which agents differ: paired differences on the same queries, with intervals, from the stored answers."""
    from vprbench.cli.comparing import compare_command

    compare_command(results, metric, reference, format)


def claims(
    folder: Annotated[Path, typer.Argument(help="Folder of auc-hsd.csv, global.csv, fit.csv, ...")] = Path("runs"),
    data: Data = None,
    format: Annotated[str, typer.Option(help="terminal, markdown, latex or csv.")] = "terminal",
) -> None:
    """Judge the paper's claims by what was measured: supported, not supported, or not testable on the data present.

    Takes the sweeps auc-hsd and global with their traces, fit.csv with fit-timings.json, and frequency.csv; what is
    not there leaves its claims untested. The roads' own figures come from KITTI's pose files.
    """
    from vprbench.cli.claiming import claims_command

    claims_command(folder, data, format)


def report(
    results: Annotated[Path, typer.Argument(help="The .csv or .parquet of a sweep.")],
    out: Annotated[Path | None, typer.Option(help="Folder of the report. Default: NAME.report beside it.")] = None,
    data: Data = None,
    routes: Routes = None,
) -> None:
    """Write a report of a sweep: one page with tables, curves, maps and frames, which opens in any browser.

    Leaves OUT/report.html, which needs no other file, and what is in it for use elsewhere: OUT/figures/ (PNG and SVG)
    and OUT/tables/ (Markdown, LaTeX and CSV). Frames are shown of the routes whose data are present.
    """
    from vprbench.cli.reporting import report_command

    report_command(results, out, data, routes)


def score(
    results: Annotated[Path, typer.Argument(help="The .csv of a sweep, or one trace (.parquet).")],
) -> None:
    """Compute the metrics and their intervals again from the stored answers, and compare them with the table.

    Exit code 1 where they differ, or where a stored answer is missing.
    """
    from vprbench.cli.reading import score_command

    raise typer.Exit(score_command(results))
