"""Learned dictionaries on disk: one .npz file of plain arrays, with the options and the reports as JSON text."""

from __future__ import annotations

import json
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float32
from numpy.typing import NDArray

from vprbench.atomic import replacing
from vprbench.errors import DataError
from vprbench_encoders.layers import LayerReport, Rates

__all__ = ["FORMAT", "Learned", "Stored", "read", "write"]

# What the file is, and the version of its layout.
FORMAT = "vprbench HSD dictionaries, version 2"


class Learned(NamedTuple):
    """What one layer has learned: its units, the mean it subtracts, and how its units compete (see `Selection`)."""

    units: Float32[np.ndarray, "units size"]
    mean: Float32[np.ndarray, " size"]
    gain: Float32[np.ndarray, " units"]
    tables: Float32[np.ndarray, "rows knots"]


@dataclass(frozen=True)
class Stored:
    """What a file holds: the encoder's options, what its layers have learned, and their reports."""

    options: Mapping[str, Any]
    layers: tuple[Learned, ...]
    reports: tuple[LayerReport, ...]


def write(path: Path, stored: Stored) -> None:
    """Write a file, whole or not at all; equal contents give equal bytes.

    Raises:
        DataError: it cannot be written there.
    """
    reports = [{"atoms": report.atoms, "units": report.units, "seconds": report.seconds} for report in stored.reports]
    header = json.dumps({"format": FORMAT, "options": dict(stored.options), "reports": reports}, sort_keys=True)
    arrays = {
        f"s{number}_{name}": array
        for number, learned in enumerate(stored.layers, 1)
        for name, array in learned._asdict().items()
    } | {f"s{number}_usage": report.usage for number, report in enumerate(stored.reports, 1)}
    try:
        with replacing(path) as temporary, temporary.open("wb") as file:
            np.savez(file, header=np.array(header), **arrays)
    except OSError as error:
        raise DataError(f"{path}: cannot be written ({error.strerror})") from error


def read(path: Path) -> Stored:
    """Read a file.

    Raises:
        DataError: it is missing, damaged or none of ours.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            return _stored(archive)
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror or error})") from error
    except (EOFError, LookupError, TypeError, ValueError, zipfile.BadZipFile, zlib.error) as error:
        raise DataError(f"{path}: damaged, or no file of {FORMAT!r}; fit the encoder again and save it") from error


def _stored(archive: Mapping[str, NDArray[Any]]) -> Stored:
    header = json.loads(str(archive["header"]))
    if header["format"] != FORMAT:
        raise ValueError(header["format"])
    layers = tuple(_learned(archive, f"s{number}_") for number in range(1, len(header["reports"]) + 1))
    reports = tuple(
        _report(fields, archive[f"s{number}_usage"], len(layers[number - 1].units))
        for number, fields in enumerate(header["reports"], 1)
    )
    return Stored(header["options"], layers, reports)


def _learned(archive: Mapping[str, NDArray[Any]], prefix: str) -> Learned:
    learned = Learned(*(archive[prefix + name] for name in Learned._fields))
    units, size = learned.units.shape
    fits = learned.mean.shape == (size,) and learned.gain.shape == (units,) and len(learned.tables) in (0, units)
    if not fits or not all(array.dtype == np.float32 and np.isfinite(array).all() for array in learned):
        raise ValueError(prefix)
    return learned


def _report(fields: Mapping[str, Any], usage: NDArray[Any], units: int) -> LayerReport:
    if usage.dtype != np.float32 or usage.shape != (units,) or not ((usage >= 0) & (usage <= 1)).all():
        raise ValueError("usage")
    return LayerReport(**{**fields, "atoms": Rates(*fields["atoms"]), "units": Rates(*fields["units"])}, usage=usage)
