"""Who a server is, and how long it may be silent."""

from __future__ import annotations

import ssl
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING

import pytest

from vprbench.errors import DataError
from vprbench.fetch.http_file import HttpFile, Patience

if TYPE_CHECKING:
    from tests.vprbench.fetch.conftest import Handler, Server

CERTIFICATE = Path(__file__).with_name("localhost.pem")


@pytest.fixture
def secure(server: Server) -> Server:
    """The server, over TLS, with a certificate that it has signed itself."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(CERTIFICATE)
    server.socket = context.wrap_socket(server.socket, server_side=True)
    (server.folder / "x").write_bytes(b"0123456789")
    return server


def test_a_server_must_prove_who_it_is(secure: Server) -> None:
    with pytest.raises(DataError, match=r"/x: the server cannot prove who it is \(.*self[- ]signed"):
        HttpFile(secure.url("x").replace("http:", "https:"))
    assert secure.log == []


def test_a_redirection_may_not_give_up_encryption(secure: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("REQUESTS_CA_BUNDLE", str(CERTIFICATE))
    url = secure.url("x").replace("http:", "https:")
    file = HttpFile(url)
    assert file.read(2, 5) == b"234"
    assert (file.size, file.requests, file.received) == (10, 2, 4)

    def downgrade(handler: Handler, start: int, stop: int) -> bool:
        handler.send_response(301)
        handler.send_header("Location", secure.url("x"))
        handler.send_header("Content-Length", "0")
        handler.end_headers()
        return True

    secure.fault = downgrade
    with pytest.raises(DataError, match=r"redirects to http://127\.0\.0\.1:\d+/x, which is not https; refused"):
        file.read(5, 10)
    file.close()


def test_a_silent_server_is_not_waited_for_without_end(server: Server) -> None:
    awake = Event()

    def sleep(handler: Handler, start: int, stop: int) -> bool:
        return awake.wait(5.0)

    server.fault = sleep
    with pytest.raises(DataError, match=r"cannot be reached \(.*[Rr]ead timed out"):
        HttpFile(server.url("x"), Patience(attempts=2, wait=0.0, timeout=0.1))
    awake.set()
    assert len(server.log) == 2
