"""A file on a web server, of which parts are read: patient with the connection, strict about the file."""

from __future__ import annotations

from dataclasses import dataclass
from time import sleep

import requests
from urllib3.exceptions import HTTPError

from vprbench.errors import DataError
from vprbench.fetch.range_request import BeyondEndError, Part, RangeRequests, TransientError, cause, shown
from vprbench.reporting import Report, silent

__all__ = ["HttpFile", "Patience"]

_AGAIN = "run the same command again: it goes on from there"


@dataclass(frozen=True)
class Patience:
    """How long to try; all values are our choice.

    Attributes:
        attempts: tries in a row that bring nothing, before it is given up.
        wait: seconds before the second of them; twice as many before each further one.
        timeout: seconds of silence after which a connection counts as dropped.
    """

    attempts: int = 5
    wait: float = 1.0
    timeout: float = 30.0


class HttpFile:
    """A file on a web server that answers range requests.

    Attributes:
        name: its address, without passwords and tokens, for messages.
        size: bytes.
        received: bytes that were read of it so far.
    """

    def __init__(self, url: str, patience: Patience | None = None) -> None:
        self._url, self.name, self.patience = url, shown(url), patience or Patience()
        self._requests = RangeRequests(self.patience.timeout)
        self._version: tuple[str | None, str | None] = (None, None)
        self.size, self.received = -1, 0
        try:
            self.read(0, 1)
        except BaseException:
            self.close()
            raise

    @property
    def requests(self) -> int:
        """How many were sent so far."""
        return self._requests.sent

    def close(self) -> None:
        """Close the connections."""
        self._requests.close()

    def read(self, start: int, stop: int, report: Report = silent) -> bytes:
        """All bytes from `start` to before `stop`; a connection that drops is taken up where it ended.

        Raises:
            DataError: the server cannot be reached, refuses ranges, does not have the file, or has another one now.
        """
        data, failures = bytearray(), 0
        while len(data) < stop - start:
            had = len(data)
            try:
                self._receive(data, start, stop, report)
            except BeyondEndError as error:
                raise self._changed("is shorter") if self.size > 0 else DataError(f"{self.name}: is empty") from error
            except (requests.RequestException, HTTPError, TransientError) as error:
                failures = 1 if len(data) > had else failures + 1
                if failures >= self.patience.attempts:
                    raise DataError(self._given_up(error, start + len(data))) from error
                sleep(self.patience.wait * 2 ** (failures - 1))
        return bytes(data)

    def _receive(self, data: bytearray, start: int, stop: int, report: Report) -> None:
        """Append what one request brings, and no more than was asked for."""
        had = len(data)
        with self._requests.part(self._url, start + had, stop) as part:
            self._check(part)
            for chunk in part.chunks():
                wanted = chunk[: stop - start - len(data)]
                data += wanted
                self.received += len(wanted)
                report("read", len(data), stop - start)
                if len(data) == stop - start:
                    break
        if len(data) == had:
            raise TransientError("an empty answer")

    def _check(self, part: Part) -> None:
        """Refuse a part of another version of the file than the first."""
        if self.size < 0:
            self.size, self._version = part.total, part.version
        elif part.total != self.size:
            raise self._changed(f"had {self.size} bytes and has {part.total}")
        elif part.version != self._version:
            raise self._changed("has another ETag or date")

    def _changed(self, how: str) -> DataError:
        return DataError(f"{self.name}: changed while it was read ({how}); {_AGAIN}")

    def _given_up(self, error: Exception, position: int) -> str:
        """What to say when patience is at its end."""
        if self.size < 0:
            return f"{self.name}: cannot be reached ({cause(error)}); check the connection, or name another --source"
        return f"{self.name}: dropped {self.patience.attempts} times at byte {position} ({cause(error)}); {_AGAIN}"
