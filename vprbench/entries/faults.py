"""What is wrong with a catalogue entry, in one line: the key, the value and the nearest allowed name."""

from __future__ import annotations

import re
from dataclasses import fields

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from vprbench.entries.folder import FolderEntry
from vprbench.entries.images import OwnCamera
from vprbench.entries.index import IndexEntry
from vprbench.entries.kitti import KittiOdometryEntry, KittiRawEntry
from vprbench.entries.robotcar import RobotCarEntry
from vprbench.entries.street import StreetEntry
from vprbench.entries.utm import UtmEntry
from vprbench.entries.vpr_bench import VprBenchEntry
from vprbench.errors import nearest
from vprbench.readers.crop import Crop
from vprbench.street.parameters import StreetParameters

__all__ = ["explain"]

_KEYS: dict[str, set[str]] = {
    "kitti-odometry": set(KittiOdometryEntry.model_fields),
    "kitti-raw": set(KittiRawEntry.model_fields),
    "folder": set(FolderEntry.model_fields),
    "index": set(IndexEntry.model_fields),
    "robotcar": set(RobotCarEntry.model_fields),
    "vpr-bench": set(VprBenchEntry.model_fields),
    "utm": set(UtmEntry.model_fields),
    "street": set(StreetEntry.model_fields) - {"parameters"} | {field.name for field in fields(StreetParameters)},
}

# The keys of the tables within an entry.
_NESTED: dict[str, set[str]] = {"camera": set(OwnCamera.model_fields), "crop": set(Crop.model_fields)}


def explain(error: ValidationError) -> str:
    """The first fault of an entry: ".camera.fxx: unknown key: did you mean 'fx'? (...)", to follow the entry's key."""
    fault = error.errors(include_url=False)[0]
    reader, *loc = fault["loc"] or ("",)
    keys = [str(part) for part in loc if part != "parameters"]
    said = _said(fault, _KEYS.get(str(reader), set()) if len(keys) < 2 else _NESTED.get(keys[0], set()))
    return "".join(f".{key}" for key in keys) + f": {said}"


def _said(fault: ErrorDetails, allowed: set[str]) -> str:
    kind, value, context = fault["type"], fault["input"], fault.get("ctx", {})
    match kind:
        case "union_tag_invalid":
            return f"unknown reader {value['reader']!r}: {nearest(str(context['tag']), _KEYS)}"
        case "union_tag_not_found":
            return f"no key 'reader': {nearest('', _KEYS)}"
        case "extra_forbidden":
            return f"unknown key: {nearest(str(fault['loc'][-1]), allowed)}"
        case "literal_error":
            choices = re.findall(r"'([^']*)'", context["expected"])
            return f"{value!r}: {nearest(str(value), choices)}"
        case "model_type" | "model_attributes_type" | "dataclass_type":
            return f"must be a table, not {value!r}"
        case "tuple_type":
            return f"must be a list, not {value!r}"
        case "missing":
            return "this key is missing"
        case "value_error":
            return str(context["error"])
        case _:
            return f"{fault['msg'].removeprefix('Input ')}, not {value!r}"
