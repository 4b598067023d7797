"""Where an archive is taken from: its publisher, a mirror, or a copy on this machine."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from urllib.parse import urlsplit

from vprbench.errors import ConfigError, nearest
from vprbench.fetch.archives import Location

__all__ = ["Addresses", "is_url"]


@dataclass(frozen=True)
class Addresses:
    """The places that a user names in place of the publisher's.

    Attributes:
        archives: address of single archives, by name.
        folders: folders and mirrors, each of which may hold any archive under its published file name.
    """

    archives: Mapping[str, str]
    folders: tuple[str, ...]

    @classmethod
    def parse(cls, sources: Iterable[str], names: Collection[str]) -> Addresses:
        """Read `--source` options: a zip, NAME=zip, a folder, or a mirror's address that ends in "/".

        Args:
            sources: as they were given; a zip is a path or an address.
            names: of the archives that are needed.

        Raises:
            ConfigError: one fits no archive, is not there, or has an address of another kind than http and https.
        """
        archives, folders = dict[str, str](), list[str]()
        for source in sources:
            name, place = _split(source, names)
            if name is None and _is_folder(place):
                folders.append(place)
            else:
                archives[_named(source, name, place, names)] = place
        return cls(archives, tuple(folders))

    def of(self, location: Location) -> str:
        """The path or address to read an archive from."""
        if location.archive in self.archives:
            return self.archives[location.archive]
        file = PurePosixPath(location.url).name
        for folder in self.folders:
            if is_url(folder):
                return folder + file
            if (Path(folder) / file).is_file():
                return str(Path(folder) / file)
        return location.url


def is_url(place: str) -> bool:
    """Whether this is an address; a drive letter is no scheme."""
    return "://" in place


def _split(source: str, names: Collection[str]) -> tuple[str | None, str]:
    """The archive's name, if the option gives one, and the place."""
    name, equals, place = source.partition("=")
    named = bool(equals) and "/" not in name and not Path(source).exists()
    if named and name not in names:
        raise ConfigError(f"--source {source}: no archive {name!r} is needed: {nearest(name, names)}")
    return (name, _checked(place, source)) if named else (None, _checked(source, source))


def _checked(place: str, source: str) -> str:
    """The place, which must be there, or have an address that can be asked."""
    if is_url(place):
        if not _is_web(place):
            raise ConfigError(f"--source {source}: give a path, or an address that begins with https:// or http://")
        return place
    path = Path(place).expanduser()
    if not path.exists():
        raise ConfigError(f"--source {source}: there is no such file or folder")
    return str(path)


def _is_web(url: str) -> bool:
    try:
        parts = urlsplit(url)
    except ValueError:
        return False
    return parts.scheme in ("http", "https") and bool(parts.hostname)


def _is_folder(place: str) -> bool:
    return place.endswith("/") if is_url(place) else Path(place).is_dir()


def _named(source: str, name: str | None, place: str, names: Collection[str]) -> str:
    """The archive that a place stands for, by its name or else by its file's."""
    path = urlsplit(place).path if is_url(place) else Path(place).as_posix()
    found = name or PurePosixPath(path).stem
    if found not in names:
        raise ConfigError(
            f"--source {source}: which archive is it? Write --source NAME={place}: {nearest(found, names)}"
        )
    return found
