"""Catalogue entries: what a route is made of, as data, one kind for each reader."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from vprbench.entries.base import Entry, Split
from vprbench.entries.folder import FolderEntry
from vprbench.entries.images import OwnCamera
from vprbench.entries.index import IndexEntry
from vprbench.entries.kitti import KittiOdometryEntry, KittiRawEntry
from vprbench.entries.robotcar import RobotCarEntry
from vprbench.entries.street import StreetEntry
from vprbench.entries.utm import UtmEntry
from vprbench.entries.vpr_bench import VprBenchEntry

__all__ = [
    "Entry",
    "FolderEntry",
    "IndexEntry",
    "KittiOdometryEntry",
    "KittiRawEntry",
    "OwnCamera",
    "RobotCarEntry",
    "RouteEntry",
    "Split",
    "StreetEntry",
    "UtmEntry",
    "VprBenchEntry",
]

RouteEntry = Annotated[
    KittiOdometryEntry
    | KittiRawEntry
    | FolderEntry
    | IndexEntry
    | VprBenchEntry
    | UtmEntry
    | RobotCarEntry
    | StreetEntry,
    Field(discriminator="reader"),
]
