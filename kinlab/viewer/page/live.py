"""The live page: a small server on loopback that shows a page and passes changes on to it.

meshcat's own server is not used: it listens on every interface. This one binds to one address,
moves on where the port is taken, and keeps the joint positions, so that a page closed and
opened again looks as it did.
"""

from __future__ import annotations

import asyncio
import errno
import ipaddress
import json
import re
import signal
import socket
import threading
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
import tornado.httpserver
import tornado.netutil
import tornado.web
import tornado.websocket

from kinlab.arrays import Array
from kinlab.errors import KinlabError, OptionError

_TRIES = 50
"""How many ports after the wanted one are tried."""

MOST_UNREAD = 8 << 20
"""Bytes that may wait for a page; more is not sent, and the page loads itself anew later."""

_HOST = re.compile(r"(?:\[([0-9a-f:.]+)\]|([a-z0-9._-]+))(?::[0-9]{1,5})?")


class Served(Protocol):
    """What the server asks of a :class:`kinlab.viewer.page.page.Page`."""

    revision: int

    def html(self, *, live: str = "") -> str:
        """The page, in touch with this server."""

    def listen(self, listener: Callable[[bytes | dict[str, Any]], None]) -> None:
        """Has every later change told to ``listener``."""

    def remember(self, q: Array) -> None:
        """Keeps where the sliders stand."""


class LiveServer:
    """Serves one page.

    Attributes:
        url: the page's address.
        port: where it listens; the wanted port, or the next free one.

    Raises:
        OptionError: the address is not this machine's, or no port near the wanted one is free.
    """

    def __init__(self, page: Served, host: str, port: int) -> None:
        self._sockets, self.port = _bind(host, port)
        self._host = host
        shown = f"[{host}]" if ":" in host else host
        self.url = f"http://{shown}:{self.port}/"
        self._page = page
        self._open: set[PageSocket] = set()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stop: asyncio.Event | None = None
        self._thread: threading.Thread | None = None

    def start(self) -> LiveServer:
        """Serves in the background until :meth:`stop` or the end of the program."""
        ready = threading.Event()
        self._thread = threading.Thread(target=lambda: asyncio.run(self._serve(ready)), daemon=True)
        self._thread.start()
        ready.wait()
        return self

    def run(self) -> None:
        """Serves until Ctrl-C or SIGTERM; call it in the main thread."""
        asyncio.run(self._serve(None))

    def stop(self) -> None:
        """Ends the server and frees its port."""
        if self._loop is not None and self._stop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._stop.set)
        if self._thread is not None:
            self._thread.join()

    async def _serve(self, ready: threading.Event | None) -> None:
        self._loop, self._stop = asyncio.get_running_loop(), asyncio.Event()
        web = tornado.web.Application(
            [
                ("/", _Html, {"page": self._page, "server": self}),
                ("/socket", PageSocket, {"server": self}),
            ]
        )
        server = tornado.httpserver.HTTPServer(web)
        server.add_sockets(self._sockets)
        self._page.listen(self._from_any_thread)
        if ready is None:
            for number in (signal.SIGINT, signal.SIGTERM):
                self._loop.add_signal_handler(number, self._stop.set)
        else:
            ready.set()
        await self._stop.wait()
        server.stop()
        for page in list(self._open):
            page.close()
        await server.close_all_connections()

    def _from_any_thread(self, message: bytes | dict[str, Any]) -> None:
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._broadcast, message)

    def _broadcast(self, message: bytes | dict[str, Any]) -> None:
        data = message if isinstance(message, bytes) else json.dumps(message)
        for page in list(self._open):
            page.tell(data)

    def connected(self, page: PageSocket) -> None:
        """A page has opened: it learns the revision, and reloads if it shows an older one."""
        self._open.add(page)
        page.tell(json.dumps({"revision": str(self._page.revision)}))

    def knows(self, host: str) -> bool:
        """Whether a request's Host is this server and not a name that was made to point here.

        A page of another site can have its own name resolved to this machine and so read from
        this server as if it were its own; an address in digits cannot be made to point anywhere.
        """
        name = _host_name(host)
        if name in ("localhost", self._host.lower()):
            return True
        try:
            asked = ipaddress.ip_address(name)
        except ValueError:
            return not _loopback(self._host) and name == socket.gethostname().lower()
        return asked.is_loopback or not _loopback(self._host)

    def disconnected(self, page: PageSocket) -> None:
        """A page has been closed."""
        self._open.discard(page)

    def moved(self, q: Any) -> None:
        """A page's slider has moved; nonsense from a page is left aside."""
        try:
            self._page.remember(np.asarray(q, dtype=float))
        except (KinlabError, TypeError, ValueError):
            return


class _Html(tornado.web.RequestHandler):
    def initialize(self, page: Served, server: LiveServer) -> None:
        self.page, self.server = page, server

    def prepare(self) -> None:
        if not self.server.knows(self.request.headers.get("Host", "")):
            raise tornado.web.HTTPError(421)

    def get(self) -> None:
        self.set_header("Cache-Control", "no-store")
        self.write(self.page.html(live=str(self.page.revision)))


class PageSocket(tornado.websocket.WebSocketHandler):
    def initialize(self, server: LiveServer) -> None:
        self.server = server
        self._waiting, self._stale = 0, False

    def prepare(self) -> None:
        if not self.server.knows(self.request.headers.get("Host", "")):
            raise tornado.web.HTTPError(421)

    def tell(self, message: str | bytes) -> None:
        """Sends a message; a page that has gone or takes nothing costs neither error nor memory."""
        if self._waiting > MOST_UNREAD:
            self._stale = True
            return
        try:
            sent = asyncio.ensure_future(
                self.write_message(message, binary=isinstance(message, bytes))
            )
        except tornado.websocket.WebSocketClosedError:
            return
        self._waiting += len(message)

        def done(future: asyncio.Future[None]) -> None:
            self._waiting -= len(message)
            if not future.cancelled():
                future.exception()  # that of a page that has gone is looked at, and left
            if self._stale and not self._waiting:
                self._stale = False
                self.tell(json.dumps({"reload": True}))

        sent.add_done_callback(done)

    def open(self, *args: str, **kwargs: str) -> None:
        self.server.connected(self)

    def on_close(self) -> None:
        self.server.disconnected(self)

    def on_message(self, message: str | bytes) -> None:
        try:
            data = json.loads(message)
        except ValueError:
            return
        if isinstance(data, dict) and "q" in data:
            self.server.moved(data["q"])


def _host_name(host: str) -> str:
    """The name in a Host header, without port and brackets; empty where it is no host."""
    found = _HOST.fullmatch(host.lower())
    return (found[1] or found[2]) if found else ""


def _loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def _bind(host: str, port: int) -> tuple[list[Any], int]:
    """Sockets on the wanted port or the next free one."""
    if not host.strip():
        raise OptionError("host is empty; give an address such as 127.0.0.1")
    if not 0 <= port <= 65535:
        raise OptionError(f"port {port}: choose 0 (any free one) to 65535")
    for candidate in range(port, min(port + _TRIES, 65536)):
        try:
            sockets = tornado.netutil.bind_sockets(candidate, address=host)
        except OSError as problem:
            if problem.errno == errno.EADDRINUSE:
                continue
            raise OptionError(f"cannot listen on {host}:{candidate} ({problem.strerror})") from None
        except (ValueError, OverflowError):  # UnicodeError too: no name that could be looked up
            raise OptionError(f"cannot listen on {host[:80]!r}: no address") from None
        return sockets, int(sockets[0].getsockname()[1])
    raise OptionError(f"ports {port} to {port + _TRIES - 1} are all taken; name another")
