"""Parts of a file on a web server, by range requests: patient with the connection, strict about the file."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from time import sleep
from urllib.parse import urljoin, urlsplit

import requests
from requests.exceptions import InvalidSchema, InvalidURL, SSLError
from urllib3.exceptions import HTTPError

from vprbench.errors import DataError
from vprbench.reporting import Report, silent

__all__ = ["HttpFile", "Patience"]

_CHUNK = 1 << 16
_REDIRECTS = 5
_TRANSIENT = (408, 429, 500, 502, 503, 504)
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
        requests: how many were sent so far.
        received: bytes that came of them.
    """

    def __init__(self, url: str, patience: Patience | None = None) -> None:
        self._url, self.name, self.patience = url, _shown(url), patience or Patience()
        self.requests, self.received = 0, 0
        self.size = -1
        self._version: tuple[str | None, str | None] = (None, None)
        self._session = _Session()
        # A compressed answer would count bytes of something else than the file.
        self._session.headers.update({"Accept-Encoding": "identity", "User-Agent": "vprbench"})
        try:
            self.read(0, 1)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the connections."""
        self._session.close()

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
            except (requests.RequestException, HTTPError, _TransientError) as error:
                failures = 1 if len(data) > had else failures + 1
                if failures >= self.patience.attempts:
                    raise DataError(self._given_up(error, start + len(data))) from error
                sleep(self.patience.wait * 2 ** (failures - 1))
        return bytes(data)

    def _receive(self, data: bytearray, start: int, stop: int, report: Report) -> None:
        """Append what one request brings."""
        first = start + len(data)
        with self._answer(first, stop) as answer:
            self._check_range(answer, first)
            # read1 gives what has come; read, and iter_content on it, lose a chunk in which the connection drops.
            while len(data) < stop - start and (chunk := answer.raw.read1(_CHUNK, decode_content=False)):
                wanted = chunk[: stop - start - len(data)]
                data += wanted
                self.received += len(wanted)
                report("read", len(data), stop - start)
        if start + len(data) == first:
            raise _TransientError("an empty answer")

    @contextmanager
    def _answer(self, start: int, stop: int) -> Iterator[requests.Response]:
        """The server's answer to a range request, after redirections."""
        url = self._url
        for _ in range(_REDIRECTS + 1):
            self.requests += 1
            with self._ask(url, start, stop) as answer:
                if not answer.is_redirect:
                    self._check_status(answer)
                    yield answer
                    return
            url = self._redirected(url, answer.headers["Location"])
        raise DataError(f"{self.name}: redirects more than {_REDIRECTS} times; name another --source")

    def _ask(self, url: str, start: int, stop: int) -> requests.Response:
        """Send one request; DataError where asking again cannot help."""
        headers = {"Range": f"bytes={start}-{stop - 1}"}
        try:
            return self._session.get(
                url, headers=headers, stream=True, allow_redirects=False, timeout=self.patience.timeout
            )
        except SSLError as error:
            raise DataError(f"{_shown(url)}: the server cannot prove who it is ({_cause(error)})") from error
        except (InvalidSchema, InvalidURL) as error:
            raise DataError(f"{_shown(url)}: not an address that can be asked ({_cause(error)})") from error

    def _redirected(self, url: str, target: str) -> str:
        """The next address, which may be no less safe than this one."""
        try:
            following = urljoin(url, target)
        except ValueError as error:
            raise DataError(
                f"{self.name}: redirects to {target!r}, which is no address; name another --source"
            ) from error
        allowed = ("https",) if urlsplit(url).scheme == "https" else ("http", "https")
        if urlsplit(following).scheme not in allowed:
            raise DataError(
                f"{self.name}: redirects to {_shown(following)}, which is not {' or '.join(allowed)}; refused"
            )
        return following

    def _check_status(self, answer: requests.Response) -> None:
        status = f"{answer.status_code} {answer.reason or ''}".strip()
        if answer.status_code == 206:
            return
        if answer.status_code in _TRANSIENT:
            raise _TransientError(status)
        if answer.status_code == 200:
            raise DataError(
                f"{self.name}: the server refuses to send parts of a file (range requests); "
                "download the whole and name it with --source FILE, or name a mirror"
            )
        if answer.status_code == 416:
            raise self._changed("is shorter") if self.size > 0 else DataError(f"{self.name}: the file there is empty")
        raise DataError(f"{self.name}: the server answers {status}; check the address, or name another --source")

    def _check_range(self, answer: requests.Response, start: int) -> None:
        """Refuse bytes from elsewhere in the file, or of another version of it."""
        text = answer.headers.get("Content-Range", "")
        match = re.fullmatch(r"bytes (\d+)-(\d+)/(\d+)", text)
        if match is None or int(match[1]) != start:
            raise DataError(
                f"{self.name}: asked for byte {start}, the server sends {text or 'no range'!r}; name a mirror"
            )
        version = (answer.headers.get("ETag"), answer.headers.get("Last-Modified"))
        if self.size < 0:
            self.size, self._version = int(match[3]), version
        elif int(match[3]) != self.size:
            raise self._changed(f"had {self.size} bytes and has {match[3]}")
        elif version != self._version:
            raise self._changed("has another ETag or date")

    def _changed(self, how: str) -> DataError:
        return DataError(f"{self.name}: changed while it was read ({how}); {_AGAIN}")

    def _given_up(self, error: Exception, position: int) -> str:
        """What to say when patience is at its end."""
        cause = _cause(error)
        if self.size < 0:
            return f"{self.name}: cannot be reached ({cause}); check the connection, or name another --source"
        return f"{self.name}: dropped {self.patience.attempts} times at byte {position} ({cause}); {_AGAIN}"


class _Session(requests.Session):
    """A session that looks at no redirection, which it would read whole before we have judged where it leads."""

    def get_redirect_target(self, resp: requests.Response) -> None:
        """None."""


class _TransientError(Exception):
    """An answer that may be another if the question is repeated."""


def _shown(url: str) -> str:
    """An address that may be told: without a user's name and password, and without what follows the path."""
    parts = urlsplit(url)
    return parts._replace(netloc=parts.netloc.rpartition("@")[2], query="", fragment="").geturl()


def _cause(error: BaseException) -> str:
    """The innermost reason of an error, in one line."""
    inner = (part for part in (getattr(error, "reason", None), *error.args) if isinstance(part, BaseException))
    deeper = next(inner, None)
    return _cause(deeper) if deeper else " ".join(str(error).split()) or type(error).__name__
