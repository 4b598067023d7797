"""Where the data sets lie on this machine."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs

from vprbench.errors import ConfigError, DataError

__all__ = ["VARIABLE", "data_root", "expanded"]

VARIABLE = "VPRBENCH_DATA"


def data_root(given: Path | str | None = None, *, there: bool = True) -> Path:
    """The folder of the data sets: the one given, else `VPRBENCH_DATA`, else the user's data folder.

    A folder that somebody named must exist (else DataError), unless `there` is false; the default one need not.
    """
    named = given or os.environ.get(VARIABLE)
    if not named:
        return platformdirs.user_data_path("vprbench")
    root = expanded(Path(named)).absolute()
    if there and not root.is_dir():
        source = "--data" if given else VARIABLE
        raise DataError(f"{source} names {root}, which is not a folder: name the one that holds the data sets")
    return root


def expanded(path: Path) -> Path:
    """The path with ~ written out; ConfigError where it names a user who has no home folder here."""
    try:
        return path.expanduser()
    except RuntimeError as error:
        raise ConfigError(f"{path}: there is no such user's folder") from error
