"""`vprbench check`: a plug-in held against its protocol."""

from __future__ import annotations

from rich.console import Console
from rich.markup import escape

from vprbench.checks import CheckResult, run_checks
from vprbench.errors import ConfigError, nearest
from vprbench.plugins import Kind, plugins

__all__ = ["check_command"]


def check_command(name: str, encoder: str | None) -> int:
    """Run every check of a plug-in; 1 if one failed."""
    console, failed = Console(), 0
    for result in run_checks(_kind(name), name, encoder=encoder):
        failed += result.fault is not None
        console.print(_line(result), highlight=False, soft_wrap=True)
    verdict = f"{failed} checks failed" if failed else "every check that applies passed"
    console.print(f"{escape(name)}: {verdict}", highlight=False)
    return 1 if failed else 0


def _line(result: CheckResult) -> str:
    """The outcome of a check, in one line."""
    if result.fault is not None:
        return f"[red]failed[/red]          {result.name}: {escape(result.fault)}"
    if result.inapplicable is not None:
        return f"[dim]does not apply[/dim]  {result.name}: {escape(result.inapplicable)}"
    return f"[green]ok[/green]              {result.name}"


def _kind(name: str) -> Kind:
    """Whether a name is an encoder's or a localizer's."""
    encoders, localizers = plugins("encoder"), plugins("localizer")
    if name not in encoders and name not in localizers:
        raise ConfigError(f"no plug-in is called {name!r}: {nearest(name, [*encoders, *localizers])}")
    return "encoder" if name in encoders else "localizer"
