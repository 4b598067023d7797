"""The table of fits on disk: what was learned in numbers, and apart from it how long that took and where.

fit.csv           one tidy row for each encoder and seed; the same code and data give the same bytes
fit-timings.json  seconds, each fit's with the machine it ran on
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from vprbench.agents import Config, label, normalise
from vprbench.atomic import replacing
from vprbench.encoder_key import training_checksum
from vprbench.errors import DataError
from vprbench.machine import machine
from vprbench.plugins import find
from vprbench.protocols import Encoder, Measured
from vprbench.provenance import versions
from vprbench.route import Route

__all__ = ["Fit", "FitTable", "as_frame", "described"]

# Measures that end so are wall-clock, which the machine decides.
_WALL_CLOCK = "_seconds"

# What names a fit.
_KEY = ("encoder", "seed")

# The columns that every row has, before those of the measures.
_COLUMNS = (
    *_KEY,
    "route",
    "encoder_config",
    "training_frames",
    "training_checksum",
    "plugin",
    "vprbench",
    "commit",
    "python",
    "libraries",
)


@dataclass(frozen=True)
class Fit:
    """One fit of one encoder.

    Attributes:
        row: what was fitted, on what and by which code.
        measures: what was learned, without any wall-clock.
        seconds: how long that took here and now; empty where it was learned before.
    """

    row: Mapping[str, str]
    measures: Mapping[str, float]
    seconds: Mapping[str, float]

    @property
    def encoder(self) -> str:
        """The encoder's label."""
        return self.row["encoder"]


def described(config: Config, seed: int, route: Route, encoder: Encoder, seconds: float | None) -> Fit:
    """The fit of an encoder on a route's training drives, in `seconds`; None where it comes from the store."""
    table = normalise(config, "encoder")
    measures = encoder.measures() if isinstance(encoder, Measured) else {}
    timed = {name: value for name, value in measures.items() if name.endswith(_WALL_CLOCK)}
    row = {
        "encoder": label(config, "encoder"),
        "seed": str(seed),
        "route": route.name,
        "encoder_config": json.dumps(table, sort_keys=True),
        "training_frames": str(sum(map(len, route.training))),
        "training_checksum": training_checksum(route.training),
        "plugin": find("encoder", table["name"]).origin,
        **versions(),
    }
    kept = {name: float(value) for name, value in measures.items() if name not in timed}
    return Fit(row, kept, {} if seconds is None else {"fit_seconds": seconds, **timed})


@dataclass
class FitTable:
    """The fits of one folder, stored as they come; a fit replaces the earlier one of its encoder and seed.

    Attributes:
        folder: must exist.
    """

    folder: Path
    _rows: dict[tuple[str, ...], dict[str, str]] = field(default_factory=dict, init=False)
    _timings: dict[tuple[str, ...], dict[str, Any]] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        """Read what is already there.

        Raises:
            DataError: it is no table of fits.
        """
        for path, entries, read in ((self.csv, self._rows, _read_csv), (self.timings, self._timings, _read_timings)):
            try:
                entries.update((_key(entry), entry) for entry in (read(path) if path.exists() else ()))
            except (OSError, ValueError, TypeError, KeyError) as error:
                raise DataError(f"{path}: not readable as a table of fits; choose another --out") from error

    @property
    def csv(self) -> Path:
        """What was learned."""
        return self.folder / "fit.csv"

    @property
    def timings(self) -> Path:
        """How long it took."""
        return self.folder / "fit-timings.json"

    def add(self, fit: Fit) -> None:
        """Store a fit; one that took no time here leaves the timing of an earlier one."""
        key = _key(fit.row)
        self._rows[key] = {**fit.row, **{name: f"{value:.6g}" for name, value in fit.measures.items()}}
        self._write_csv()
        if fit.seconds:
            identity = {name: fit.row[name] for name in (*_KEY, "route", "training_checksum")}
            self._timings[key] = {**identity, "seconds": dict(fit.seconds), "machine": machine()}
            with replacing(self.timings) as path:
                path.write_text(json.dumps({"fits": _sorted(self._timings)}, indent=1) + "\n", "utf-8")

    def _write_csv(self) -> None:
        rows = _sorted(self._rows)
        columns = dict.fromkeys((*_COLUMNS, *(name for row in rows for name, value in row.items() if value)))
        with replacing(self.csv) as path, path.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, columns, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


def as_frame(fits: Iterable[Fit]) -> pd.DataFrame:
    """One row a fit: encoder, seed, and every number, seconds included; NaN where it has none."""
    return pd.DataFrame([{**{name: fit.row[name] for name in _KEY}, **fit.measures, **fit.seconds} for fit in fits])


def _key(row: Mapping[str, str]) -> tuple[str, ...]:
    """What names a fit; ValueError where its seed is no number."""
    return row["encoder"], str(int(row["seed"]))


def _read_csv(path: Path) -> list[dict[str, Any]]:
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file, strict=True))
    if any(name not in row or None in row for row in rows for name in _COLUMNS):
        raise ValueError(path)
    return rows


def _read_timings(path: Path) -> list[dict[str, Any]]:
    return [{**fit} for fit in json.loads(path.read_text("utf-8"))["fits"]]


def _sorted(entries: Mapping[tuple[str, ...], dict[str, Any]]) -> list[dict[str, Any]]:
    """By encoder, then by seed as a number."""
    return [entries[key] for key in sorted(entries, key=lambda key: (key[0], int(key[1])))]
