"""The viewer's server answers its own page only."""

from __future__ import annotations

import http.client
import time

import numpy as np
import pytest
from tornado.websocket import WebSocketClosedError

import kinlab as kl
from kinlab.errors import OptionError
from kinlab.viewer.page.live import LiveServer
from kinlab.viewer.scene import Scene


def status(port: int, host: str) -> int:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.putrequest("GET", "/", skip_host=True)
    connection.putheader("Host", host)
    connection.endheaders()
    try:
        return connection.getresponse().status
    finally:
        connection.close()


@pytest.fixture(scope="module")
def server():
    running = Scene(kl.load("planar2r")).serve(port=0)
    yield running
    running.stop()


@pytest.mark.parametrize(
    "host", ["127.0.0.1", "localhost", "LOCALHOST:9999", "[::1]:80", "127.0.0.2:1"]
)
def test_its_own_names_are_known(server, host):
    assert status(server.port, host) == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "127.0.0.1.evil.example",
        "[::1].evil",
        "127.0.0.1@evil",
        "10.0.0.1",
        "*",
        "x:1:2",
    ],
)
def test_a_name_made_to_point_here_is_refused(server, host):
    assert 400 <= status(server.port, host) < 500


@pytest.mark.parametrize("host", ["", "  ", "x" * 300, "a\0b"])
def test_a_host_that_is_none_is_refused(host):
    with pytest.raises(OptionError):
        LiveServer(Scene(kl.load("planar2r")), host, 0)


def test_a_page_that_takes_nothing_is_let_wait():
    import asyncio

    from kinlab.viewer.page import live

    class Deaf(live.PageSocket):
        def __init__(self) -> None:
            self.sent: list[str] = []
            self.initialize(None)
            self.held: list[asyncio.Future[None]] = []

        def write_message(self, message, binary=False):
            self.sent.append(message)
            self.held.append(asyncio.get_running_loop().create_future())
            return self.held[-1]

    class Gone(Deaf):
        def write_message(self, message, binary=False):
            raise WebSocketClosedError

    async def play() -> list[str]:
        Gone().tell("x")
        page = Deaf()
        for _ in range(400):
            page.tell("x" * (1 << 20))
        assert sum(map(len, page.sent)) <= live.MOST_UNREAD + (1 << 20)
        for future in page.held:
            future.set_result(None)
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        return page.sent

    assert asyncio.run(play())[-1] == '{"reload": true}'


def test_departed_pages_leave_the_server_well(server):
    import socket

    for _ in range(5):
        client = socket.create_connection(("127.0.0.1", server.port))
        client.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        client.close()
    time.sleep(0.2)
    assert status(server.port, "localhost") == 200
    assert np.isfinite(server.port)
