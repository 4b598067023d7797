"""`vprbench list`: what there is to run, and whether its data are here."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from vprbench.catalogue import catalogue
from vprbench.data_root import data_root
from vprbench.errors import ConfigError, nearest
from vprbench.plugins import Kind, plugins
from vprbench.sweep import builtin_sweeps, parse_sweep

__all__ = ["list_command"]

KINDS: tuple[Kind, ...] = ("encoder", "localizer")


def list_command(what: str, data: Path | None, routes: Path | None) -> None:
    """Print the lists asked for."""
    console = Console()
    lists = {
        "routes": lambda: _routes(data, routes),
        "encoders": lambda: _plugins("encoder"),
        "localizers": lambda: _plugins("localizer"),
        "sweeps": _sweeps,
    }
    if what not in {*lists, "all"}:
        raise ConfigError(f"cannot list {what!r}: {nearest(what, [*lists, 'all'])}")
    for name in lists if what == "all" else [what]:
        console.print(lists[name]())
    for kind in KINDS:
        if what in ("all", f"{kind}s"):
            _print_faults(kind, console)


def _routes(data: Path | None, own: Path | None) -> Table:
    """Every route, and how many of its frames are present."""
    known = catalogue(own)
    table = _table(f"routes (data root: {data_root(data)})", "name", "split", "environment", "data")
    for name in known.names():
        entry, there = known.entry(name), known.availability(name, data)
        if not there.needs:
            state = "drawn, needs none"
        elif there.complete:
            state = f"[green]all {there.present} frames[/green]"
        else:
            state = f"[yellow]{there.present} of {there.present + there.missing} frames[/yellow]"
        table.add_row(escape(name), escape(entry.split), escape(entry.environment), state)
    return table


def _plugins(kind: Kind) -> Table:
    """Every plug-in of a kind, where it comes from, and whether it loads."""
    table = _table(f"{kind}s", "name", "distribution", "from", "state")
    for plugin in plugins(kind).values():
        state = "[red]does not load[/red]" if plugin.fault() else "[green]ok[/green]"
        table.add_row(escape(plugin.name), escape(plugin.origin), escape(plugin.value), state)
    return table


def _print_faults(kind: Kind, console: Console) -> None:
    """Why plug-ins do not load, below the tables, where there is room to say it."""
    for plugin in plugins(kind).values():
        if fault := plugin.fault():
            console.print(f"[red]{escape(fault)}[/red]", highlight=False)


def _sweeps() -> Table:
    """Every built-in sweep."""
    table = _table("sweeps", "name", "cells", "asks")
    for name, path in builtin_sweeps().items():
        sweep = parse_sweep(path)
        table.add_row(escape(name), str(len(list(sweep.cells()))), escape(sweep.description))
    return table


def _table(title: str, *columns: str) -> Table:
    """An empty list."""
    table = Table(title=escape(title), title_justify="left", title_style="bold", box=None, pad_edge=False)
    for column in columns:
        table.add_column(column)
    return table
