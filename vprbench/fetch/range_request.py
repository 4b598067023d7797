"""One request for a part of a file on a web server: where it may lead, and which answers count."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from urllib.parse import urljoin, urlsplit

import requests
from requests.exceptions import InvalidSchema, InvalidURL, SSLError

from vprbench.errors import DataError

__all__ = ["BeyondEndError", "Part", "RangeRequests", "TransientError", "cause", "shown"]

_CHUNK = 1 << 16
_REDIRECTS = 5
_TRANSIENT = (408, 429, 500, 502, 503, 504)


class TransientError(Exception):
    """An answer that may be another if the question is repeated."""


class BeyondEndError(Exception):
    """The file ends before the part begins."""


@dataclass(frozen=True)
class Part:
    """A part of a file, on its way.

    Attributes:
        total: size of the whole file, bytes.
        version: its ETag and date, as far as the server says them.
        answer: what the server sends.
    """

    total: int
    version: tuple[str | None, str | None]
    answer: requests.Response

    def chunks(self) -> Iterator[bytes]:
        """The bytes as they come."""
        # read1 gives what there is; read, and iter_content on it, lose a chunk in which the connection drops.
        while chunk := self.answer.raw.read1(_CHUNK, decode_content=False):
            yield chunk


class RangeRequests:
    """Range requests over connections that are kept.

    Attributes:
        timeout: seconds of silence after which a connection counts as dropped.
        sent: how many requests were sent.
    """

    def __init__(self, timeout: float) -> None:
        self.timeout, self.sent = timeout, 0
        self._session = _Session()
        # A compressed answer would count bytes of something else than the file.
        self._session.headers.update({"Accept-Encoding": "identity", "User-Agent": "vprbench"})

    def close(self) -> None:
        """Close the connections."""
        self._session.close()

    @contextmanager
    def part(self, url: str, start: int, stop: int) -> Iterator[Part]:
        """The bytes from `start` to before `stop`, or fewer, after redirections.

        Raises:
            DataError: the server will not give them, however often it is asked.
            TransientError: it does not now.
            BeyondEndError: there are none.
            requests.RequestException: it cannot be talked to.
        """
        asked = url
        for _ in range(_REDIRECTS + 1):
            self.sent += 1
            with self._ask(asked, start, stop) as answer:
                if not answer.is_redirect:
                    _check_status(answer, url)
                    yield _part(answer, url, start)
                    return
            asked = _redirected(url, asked, answer.headers["Location"])
        raise DataError(f"{shown(url)}: redirects more than {_REDIRECTS} times; name another --source")

    def _ask(self, url: str, start: int, stop: int) -> requests.Response:
        """Send one request; DataError where asking again cannot help."""
        headers = {"Range": f"bytes={start}-{stop - 1}"}
        try:
            return self._session.get(url, headers=headers, stream=True, allow_redirects=False, timeout=self.timeout)
        except SSLError as error:
            raise DataError(f"{shown(url)}: the server cannot prove who it is ({cause(error)})") from error
        except (InvalidSchema, InvalidURL) as error:
            raise DataError(f"{shown(url)}: not an address that can be asked ({cause(error)})") from error


class _Session(requests.Session):
    """A session that looks at no redirection, which it would read whole before we have judged where it leads."""

    def get_redirect_target(self, resp: requests.Response) -> None:
        """None."""


def _redirected(url: str, asked: str, target: str) -> str:
    """The next address, which may be no less safe than the one before."""
    try:
        following = urljoin(asked, target)
    except ValueError as error:
        raise DataError(f"{shown(url)}: redirects to {target!r}, which is no address; name another --source") from error
    allowed = ("https",) if urlsplit(asked).scheme == "https" else ("http", "https")
    if urlsplit(following).scheme not in allowed:
        raise DataError(f"{shown(url)}: redirects to {shown(following)}, which is not {' or '.join(allowed)}; refused")
    return following


def _check_status(answer: requests.Response, url: str) -> None:
    """Raise unless the answer is a part of a file."""
    status = f"{answer.status_code} {answer.reason or ''}".strip()
    if answer.status_code == 206:
        return
    if answer.status_code in _TRANSIENT:
        raise TransientError(status)
    if answer.status_code == 416:
        raise BeyondEndError
    if answer.status_code == 200:
        raise DataError(
            f"{shown(url)}: the server refuses to send parts of a file (range requests); "
            "download the whole and name it with --source FILE, or name a mirror"
        )
    raise DataError(f"{shown(url)}: the server answers {status}; check the address, or name another --source")


def _part(answer: requests.Response, url: str, start: int) -> Part:
    """What the answer's headers say of it; DataError where it is not what was asked for."""
    text = answer.headers.get("Content-Range", "")
    match = re.fullmatch(r"bytes (\d+)-(\d+)/(\d+)", text)
    if match is None or int(match[1]) != start:
        raise DataError(f"{shown(url)}: asked for byte {start}, the server sends {text or 'no range'!r}; name a mirror")
    return Part(int(match[3]), (answer.headers.get("ETag"), answer.headers.get("Last-Modified")), answer)


def shown(url: str) -> str:
    """An address that may be told: without a user's name and password, and without what follows the path."""
    parts = urlsplit(url)
    return parts._replace(netloc=parts.netloc.rpartition("@")[2], query="", fragment="").geturl()


def cause(error: BaseException) -> str:
    """The innermost reason of an error, in one line."""
    inner = (part for part in (getattr(error, "reason", None), *error.args) if isinstance(part, BaseException))
    deeper = next(inner, None)
    return cause(deeper) if deeper else " ".join(str(error).split()) or type(error).__name__
