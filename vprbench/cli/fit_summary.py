"""What fits came to, on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import mean, stdev

from rich import box
from rich.table import Table
from rich.text import Text

from vprbench.fit_table import Fit

__all__ = ["fits_to_terminal"]


def fits_to_terminal(fits: Sequence[Fit]) -> Table:
    """One line a measure, one column an encoder: the mean over seeds, and ± the sd where there are several."""
    encoders = list(dict.fromkeys(fit.encoder for fit in fits))
    measures = dict.fromkeys(name for fit in fits for name in (*fit.measures, *fit.seconds))
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column(Text("mean ± sd over seeds"), no_wrap=True)
    for encoder in encoders:
        table.add_column(Text(encoder), justify="right", no_wrap=True)
    for name in measures:
        values = [[{**fit.measures, **fit.seconds}.get(name) for fit in fits if fit.encoder == e] for e in encoders]
        table.add_row(Text(name), *(_entry([value for value in row if value is not None]) for row in values))
    return table


def _entry(values: Sequence[float]) -> Text:
    """Mean and sd; a dash where nothing was measured."""
    if not values:
        return Text("-", "dim")
    spread = f" ± {stdev(values):.3g}" if len(values) > 1 else ""
    return Text(f"{mean(values):.4g}{spread}")
