"""Where the data sets lie on this machine."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs

from vprbench.errors import DataError

__all__ = ["VARIABLE", "data_root"]

VARIABLE = "VPRBENCH_DATA"


def data_root(given: Path | str | None = None, *, there: bool = True) -> Path:
    """The folder of the data sets: the one given, else `VPRBENCH_DATA`, else the user's data folder.

    A folder that somebody named must exist (else DataError), unless `there` is false; the default one need not.
    """
    named = given or os.environ.get(VARIABLE)
    if not named:
        return platformdirs.user_data_path("vprbench")
    root = Path(named).expanduser().absolute()
    if there and not root.is_dir():
        source = "--data" if given else VARIABLE
        raise DataError(f"{source} names {root}, which is not a folder: name the one that holds the data sets")
    return root
