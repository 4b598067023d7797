"""What of a study is there already, from the same data and configurations as today's."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any

import pandas as pd

from vprbench.agents import is_seeded, label, normalise
from vprbench.encoder_key import training_checksum
from vprbench.frequency.question import default_question
from vprbench.provenance import data_checksum
from vprbench.route import Route
from vprbench.studies import FitStudy, FrequencyStudy, PlaceFieldsStudy

__all__ = ["fields_kept", "fields_stamp", "fits_missing", "frequency_kept"]


def fits_missing(study: FitStudy, route: Route, folder: Path) -> dict[tuple[int, ...], list[str]]:
    """The encoders that are to be fitted, by the seeds that each lacks: in fit.csv, or in time in fit-timings.json."""
    rows = _rows(folder / "fit.csv", lambda path: pd.read_csv(path, dtype=str).to_dict("records"))
    timed = _rows(folder / "fit-timings.json", lambda path: json.loads(path.read_text("utf-8"))["fits"])
    checksum = training_checksum(route.training)
    fits, times = ({(str(row.get("encoder")), str(row.get("seed"))): row for row in found} for found in (rows, timed))
    missing: dict[tuple[int, ...], list[str]] = {}
    for encoder in study.encoders:
        config, lacking = json.dumps(normalise(encoder, "encoder"), sort_keys=True), []
        for seed in study.seeds if is_seeded(encoder, "encoder") else study.seeds[:1]:
            key = (label(encoder, "encoder"), str(seed))
            fit, time = fits.get(key, {}), times.get(key, {})
            kept = fit.get("encoder_config") == config and fit.get("training_checksum") == checksum
            if not (kept and time.get("training_checksum") == checksum):
                lacking.append(seed)
        if lacking:
            missing.setdefault(tuple(lacking), []).append(encoder)
    return missing


def frequency_kept(study: FrequencyStudy, route: Route, folder: Path) -> bool:
    """Whether every agent was timed for all rounds on these data."""
    question = default_question()
    stamps = _rows(folder / "frequency.json", lambda path: [json.loads(path.read_text("utf-8"))])
    rows = _rows(folder / "frequency.csv", lambda path: pd.read_csv(path).to_dict("records"))
    if not rows or not stamps or stamps[0].get("data_checksum") != data_checksum(route):
        return False
    timed = stamps[0].get("agents", {})
    asked = {name: question.agents[name] for name in question.agents if not study.agents or name in study.agents}
    same = all(timed.get(name, {}).get("config") == normalise(config) for name, config in asked.items())
    return same and all(row.get("rounds", 0) >= (study.rounds or question.rounds) for row in rows)


def fields_kept(study: PlaceFieldsStudy, route: Route, folder: Path) -> bool:
    """Whether the place fields of this agent on these data are there, drawn too."""
    drawn = [folder / "figures" / f"{study.name}.{kind}" for kind in ("png", "svg")]
    stamps = _rows(folder / f"{study.name}.json", lambda path: [json.loads(path.read_text("utf-8"))])
    files: Collection[Path] = (folder / f"{study.name}.csv", *drawn)
    return all(path.exists() for path in files) and stamps == [fields_stamp(study, route)]


def fields_stamp(study: PlaceFieldsStudy, route: Route) -> dict[str, Any]:
    """What place fields depend on."""
    return {
        "route": route.name,
        "data_checksum": data_checksum(route),
        "agent": normalise(study.agent),
        "sampling_distance_m": study.sampling_distance,
        "seed": study.seed,
    }


def _rows(path: Path, read: Callable[[Path], list[Any]]) -> list[Any]:
    """The entries of a file; none where it is missing or damaged, so that it is made anew."""
    try:
        return read(path) if path.exists() else []
    except (OSError, ValueError, KeyError, TypeError):
        return []
