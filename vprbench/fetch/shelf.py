"""The archives in use, each opened when it is first asked for."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType

from vprbench.fetch.addresses import Addresses, is_url
from vprbench.fetch.archives import Location
from vprbench.fetch.byte_source import LocalFile
from vprbench.fetch.contents import Contents
from vprbench.fetch.http_file import HttpFile

__all__ = ["Shelf"]


class Shelf:
    """Open archives, closed together.

    Attributes:
        addresses: where archives are taken from.
    """

    def __init__(self, addresses: Addresses) -> None:
        self.addresses = addresses
        self._sources: list[LocalFile | HttpFile] = []
        self._open: dict[str, Contents] = {}

    def __enter__(self) -> Shelf:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for source in self._sources:
            source.close()

    def contents(self, location: Location) -> Contents:
        """What the archive of a file holds; DataError where it cannot be read."""
        place = self.addresses.of(location)
        if place not in self._open:
            source = HttpFile(place) if is_url(place) else LocalFile(Path(place))
            self._sources.append(source)
            self._open[place] = Contents(source)
        return self._open[place]

    @property
    def requests(self) -> int:
        """How many requests were sent to servers."""
        return sum(source.requests for source in self._sources if isinstance(source, HttpFile))

    @property
    def received(self) -> int:
        """How many bytes came of them."""
        return sum(source.received for source in self._sources if isinstance(source, HttpFile))
