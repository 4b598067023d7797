"""`vprbench claims`: the paper's claims beside what was measured, each with its verdict."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pandas as pd
from rich.console import Console

from vprbench.claims import evaluate
from vprbench.claims.formats import to_latex, to_markdown, to_terminal
from vprbench.errors import ConfigError, nearest

__all__ = ["claims_command"]


def claims_command(folder: Path, data: Path | None, format: str) -> None:
    """Judge every claim, and print the table."""
    writers: dict[str, Callable[[pd.DataFrame], str]] = {"markdown": to_markdown, "latex": to_latex, "csv": _csv}
    if format not in {*writers, "terminal"}:
        raise ConfigError(f"--format {format!r}: {nearest(format, [*writers, 'terminal'])}")
    table = evaluate(folder, data)
    console = Console()
    if format == "terminal":
        console.print(to_terminal(table))
    else:
        console.out(writers[format](table), highlight=False, end="")


def _csv(table: pd.DataFrame) -> str:
    """Tidy CSV with the exact figures."""
    return table.to_csv(index=False, lineterminator="\n")
