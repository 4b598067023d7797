"""Which public archive holds a file, under which name, and under what licence: `data/archives.toml`."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import PurePosixPath

from pydantic import BaseModel, ConfigDict

__all__ = ["Archive", "DataSet", "Location", "data_sets", "locations"]


class Archive(BaseModel):
    """A zip archive, or a family of them whose addresses differ in parts of their files' paths.

    Attributes:
        url: its address.
        files: the paths below the data root of the files that it holds, as a regular expression.
        member: what such a file is called in it.
        size: of the whole archive, in words; empty where its publisher states none.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    url: str
    files: re.Pattern[str]
    member: str
    size: str = ""


class DataSet(BaseModel):
    """What is published together, under one licence.

    Attributes:
        title: what it is called.
        home: the page that describes it.
        licence: its name, its address and what it asks.
        citation: what to cite.
        archives: where its files are, the preferred one of a file first.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    title: str
    home: str
    licence: str
    citation: str
    archives: tuple[Archive, ...]


@dataclass(frozen=True)
class Location:
    """Where one file is published.

    Attributes:
        url: the archive's address.
        member: the file's name in it.
        data_set: what it is part of.
        size: of the whole archive, in words.
    """

    url: str
    member: str
    data_set: DataSet
    size: str = ""

    @property
    def archive(self) -> str:
        """The archive's name: its file's, without the suffix."""
        return PurePosixPath(self.url).stem


@cache
def data_sets() -> tuple[DataSet, ...]:
    """Every data set that can be fetched."""
    text = (resources.files("vprbench") / "data" / "archives.toml").read_text("utf-8")
    return tuple(DataSet.model_validate(table) for table in tomllib.loads(text)["data_sets"])


def locations(path: PurePosixPath, known: Iterable[DataSet] | None = None) -> tuple[Location, ...]:
    """Where a file, given by its path below the data root, is published; the preferred place first."""
    return tuple(_locations(str(path), data_sets() if known is None else known))


def _locations(path: str, known: Iterable[DataSet]) -> Iterator[Location]:
    for data_set in known:
        for archive in data_set.archives:
            match = archive.files.fullmatch(path)
            if match is not None:
                groups = match.groupdict()
                url, member = archive.url.format(**groups), archive.member.format(**groups)
                yield Location(url, member, data_set, archive.size)
