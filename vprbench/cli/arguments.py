"""Options that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

__all__ = ["Data", "Routes"]

Data = Annotated[
    Path | None,
    typer.Option(help="Folder that holds KITTI's dataset/. Default: $VPRBENCH_DATA, else the user data folder."),
]
Routes = Annotated[Path | None, typer.Option(help="TOML file with routes of your own.")]
