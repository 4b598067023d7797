"""The commands about data: `vprbench data check` and `vprbench data revisits`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vprbench.cli.arguments import Data, Routes

__all__ = ["check", "data", "revisits"]

data = typer.Typer(no_args_is_help=True, help="Check the data of routes, and find roads driven twice.")


@data.command(epilog="Example: vprbench data check KITTI-K0-2 --data ~/kitti --figures")
def check(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="ROUTE", help="Routes; by default all of the --routes file.")
    ] = None,
    data: Data = None,
    routes: Routes = None,
    out: Annotated[Path, typer.Option(help="Folder of the figures.")] = Path("runs"),
    figures: Annotated[bool, typer.Option("--figures", help="Draw a map (needs the figures extra).")] = False,
    format: Annotated[str, typer.Option(help="terminal or json.")] = "terminal",
) -> None:
    """Check the data of routes: frames, poses, times, duplicates, how the drives lie, training beside the road.

    Exit code 1 if the data of a route cannot be used as they are; warnings do not count.
    """
    from vprbench.cli.data_checking import DataCheck, data_check_command

    raise typer.Exit(data_check_command(DataCheck(names or [], data, routes, out, figures, format)))


@data.command(epilog="Example: vprbench data revisits 00 --data ~/kitti > my.toml")
def revisits(
    recording: Annotated[
        str,
        typer.Argument(
            metavar="RECORDING",
            help="A KITTI sequence (00), a raw drive (2011_10_03_drive_0027), or a drive's CSV or folder.",
        ),
    ],
    data: Data = None,
    direction: Annotated[str, typer.Option(help="Of the second drive: same, reverse or both.")] = "same",
    length: Annotated[float, typer.Option(min=1, help="Least metres of road driven twice.")] = 50.0,
    field_of_view: Annotated[
        float, typer.Option(min=1, max=179, help="Of the camera of a drive of your own, horizontal, degrees.")
    ] = 82.0,
) -> None:
    """Find roads that a recording drives twice, and propose routes there: a TOML file for --routes, on stdout."""
    from vprbench.cli.revisiting import revisits_command

    revisits_command(recording, data, direction, length, field_of_view)
