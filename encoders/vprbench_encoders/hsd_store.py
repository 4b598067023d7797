"""Learned dictionaries on disk: one .npz file of plain arrays, with the options and the reports as JSON text."""

from __future__ import annotations

import json
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vprbench.atomic import replacing
from vprbench.errors import DataError
from vprbench_encoders.layers import LayerReport, Rates, TopologicalLayer
from vprbench_encoders.matching_pursuit import Selection

__all__ = ["FORMAT", "Stored", "read", "write"]

# What the file is, and the version of its layout.
FORMAT = "vprbench HSD dictionaries, version 1"

_ARRAYS = {"units": np.float32, "mean": np.float32, "gain": np.float32, "tables": np.float32, "cells": np.int64}


@dataclass(frozen=True)
class Stored:
    """What a file holds: the encoder's options, its layers and their reports."""

    options: Mapping[str, Any]
    layers: tuple[TopologicalLayer, ...]
    reports: tuple[LayerReport, ...]


def write(path: Path, stored: Stored) -> None:
    """Write a file, whole or not at all; equal contents give equal bytes.

    Raises:
        DataError: it cannot be written there.
    """
    layers = [{"picks": layer.picks, "rectified": layer.rectified} for layer in stored.layers]
    reports = [asdict(report) for report in stored.reports]
    header = {"format": FORMAT, "options": dict(stored.options), "layers": layers, "reports": reports}
    arrays = {
        f"s{number}_{name}": array
        for number, layer in enumerate(stored.layers, 1)
        for name, array in _arrays(layer).items()
    }
    try:
        with replacing(path) as temporary, temporary.open("wb") as file:
            np.savez(file, header=np.array(json.dumps(header, sort_keys=True)), **arrays)  # type: ignore[arg-type]
    except OSError as error:
        raise DataError(f"{path}: cannot be written ({error.strerror})") from error


def read(path: Path) -> Stored:
    """Read a file.

    Raises:
        DataError: it is missing, damaged or none of ours.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            return _stored(archive)
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror or error})") from error
    except (AttributeError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile, zlib.error) as error:
        raise DataError(f"{path}: damaged, or no file of {FORMAT!r}; fit the encoder again and save it") from error


def _stored(archive: Mapping[str, NDArray[Any]]) -> Stored:
    header = json.loads(str(archive["header"]))
    if header["format"] != FORMAT:
        raise ValueError(header["format"])
    layers = tuple(_layer(archive, number, **fields) for number, fields in enumerate(header["layers"], 1))
    return Stored(header["options"], layers, tuple(map(_report, header["reports"])))


def _arrays(layer: TopologicalLayer) -> dict[str, NDArray[Any]]:
    gain, tables = layer.selection
    return {"units": layer.units, "mean": layer.mean, "gain": gain, "tables": tables, "cells": layer.cells}


def _layer(archive: Mapping[str, NDArray[Any]], number: int, picks: int, rectified: bool) -> TopologicalLayer:
    arrays = {name: archive[f"s{number}_{name}"] for name in _ARRAYS}
    units = len(arrays["units"])
    shapes = {"units": (units, len(arrays["mean"])), "gain": (units,), "cells": (units,)}
    for name, array in arrays.items():
        if array.dtype != _ARRAYS[name] or array.shape != shapes.get(name, array.shape) or not np.isfinite(array).all():
            raise ValueError(name)
    selection = Selection(arrays["gain"], arrays["tables"])
    return TopologicalLayer(arrays["units"], arrays["mean"], selection, arrays["cells"], picks, rectified)


def _report(fields: dict[str, Any]) -> LayerReport:
    return LayerReport(Rates(*fields.pop("atoms")), Rates(*fields.pop("units")), **fields)
