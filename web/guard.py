"""The guard at the door: who may connect, how much and how fast a browser may send, and what gets through.

It stands between the websocket and viser, so that viser never sees a message which `filter` has not let through.
It reaches into viser's internals (see `server.py`), hence the pinned version.
"""

from __future__ import annotations

import asyncio
import ipaddress
import logging
import socket
import time
from collections.abc import Awaitable, Callable
from http import HTTPStatus
from typing import Any
from urllib.parse import urlsplit

import viser
from websockets import Headers
from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosedError
from websockets.http11 import Request, Response

from web.filter import QUIET, Refused, check_message, read_message

LARGEST_MESSAGE = 64 * 1024  # bytes; the longest that a page of ours sends is below 1 kB
MESSAGES_PER_SECOND = 200.0  # a hand on the mouse makes about 70
BURST = 400.0  # messages at once, as when a tab comes back from sleep
MOST_CLIENTS = 32
PATIENCE = 5.0  # s of flood without a pause, after which its sender has to go
RECOVERED = 0.5  # of the burst: who has that much left again has paused; less may come from a sleep that took too long
LOG_LINES_PER_CLIENT = 20  # then silence, so that a hostile client cannot fill a disk
LOG_LINES_PER_SECOND = 2.0  # of all clients together, after a burst; one may connect again and again
LOG_BURST = 200.0

log = logging.getLogger("tumble.web")

Handler = Callable[[Any], Awaitable[None]]
Screen = Callable[[ServerConnection, Request], Response | None]


class Guard:
    """One for a page. `open` lets the browsers in, which wait at the door until the page is complete."""

    def __init__(self, host: str) -> None:
        name = socket.gethostname().lower()
        self._names = {"localhost", host.lower(), name, f"{name}.local"}
        self._server: viser.ViserServer | None = None
        self._opened = asyncio.Event()
        self._clients = 0
        self._log_allowance = Allowance(LOG_LINES_PER_SECOND, LOG_BURST)

    def report(self, line: str, *values: object) -> None:
        """A warning about what somebody outside did, which is dropped when there were too many already."""
        if self._log_allowance.spend():
            log.warning(line, *values)

    def open(self, server: viser.ViserServer) -> None:
        self._server = server
        server.get_event_loop().call_soon_threadsafe(self._opened.set)

    def screened(self, serve_file: Screen | None) -> Screen:
        """viser's file server, behind the check of who asks."""

        def screen(connection: ServerConnection, request: Request) -> Response | None:
            problem = self._problem_with(request.headers)
            if problem:
                self.report("refused a request: %s", problem)
                return Response(HTTPStatus.FORBIDDEN, "Forbidden", Headers(), b"refused: " + problem.encode())
            response = serve_file(connection, request) if serve_file else None
            if response is not None:
                _harden(response.headers)
            return response

        return screen

    def guarded(self, handler: Handler) -> Handler:
        """viser's handler of one connection, reading through the filter."""

        async def handle(connection: ServerConnection) -> None:
            if self._clients >= MOST_CLIENTS:
                self.report("refused a client: %d are connected already", self._clients)
                await connection.close(1013, "too many clients")
                return
            self._clients += 1
            try:
                await self._opened.wait()
                assert self._server is not None
                await handler(FilteredConnection(connection, self._server, self.report))
            finally:
                self._clients -= 1

        return handle

    def _problem_with(self, headers: Headers) -> str:
        """Why this request is refused, empty if it is not: other sites and rebound names must not drive the page."""
        try:
            hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
            name = urlsplit(f"//{hosts[0]}").hostname or "" if len(hosts) == 1 else ""
            if not self._is_ours(name):
                return "the Host header does not name this server"
            if origins and [urlsplit(origin).netloc for origin in origins] != hosts:
                return "it comes from another site"
        except ValueError:
            return "its headers make no sense"
        protocol = headers.get("Sec-WebSocket-Protocol")
        if headers.get("Upgrade") and protocol != f"viser-v{viser.__version__}":
            return "it speaks another version of viser"
        return ""

    def _is_ours(self, name: str) -> bool:
        """A rebound name is a name: addresses cannot be forged that way."""
        if name.lower() in self._names:
            return True
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return False
        return True


class FilteredConnection:
    """A websocket as viser uses it, of which `recv` returns only what is allowed, and not faster than allowed."""

    def __init__(self, connection: ServerConnection, server: viser.ViserServer, report: Callable[..., None]) -> None:
        self._connection = connection
        self._server = server
        self._log = report
        self._allowance = Allowance()
        self._flooded_since: float | None = None
        self._warned = False
        self._lines_left = LOG_LINES_PER_CLIENT

    def __getattr__(self, name: str) -> Any:
        return getattr(self._connection, name)

    async def recv(self) -> bytes:
        while True:
            raw = await self._connection.recv()
            await self._keep_pace()
            try:
                message = read_message(raw)
                if message["type"] in QUIET:
                    continue
                check_message(message, self._server)
            except Refused as refusal:
                self._report(f"ignored: {refusal}")
                continue
            assert isinstance(raw, bytes)
            return raw

    async def _keep_pace(self) -> None:
        """Not reading is what slows a flood down: it fills its own pipe, and no message of an honest client is lost."""
        wait = self._allowance.take()
        if self._allowance.left >= RECOVERED * BURST:
            self._flooded_since = None
        if wait == 0.0:
            return
        now = time.monotonic()
        if self._flooded_since is None:
            self._flooded_since = now
            self._warn()
        if now - self._flooded_since > PATIENCE:
            self._say("thrown out: too many messages for too long")
            self._connection.transport.abort()
            raise ConnectionClosedError(None, None)
        await asyncio.sleep(wait)

    def _warn(self) -> None:
        if not self._warned:
            self._warned = True
            self._say("slowed down: too many messages")

    def _report(self, line: str) -> None:
        """What a client can do as often as it likes; what it can do once is said in any case."""
        if self._lines_left > 0:
            self._lines_left -= 1
            self._say(line if self._lines_left else f"{line} (last report)")

    def _say(self, line: str) -> None:
        address = self._connection.remote_address
        self._log("client %s %s", address and address[:2], line)


class Allowance:
    """How many messages a client may still send: it refills with time, up to a burst."""

    def __init__(self, per_second: float = MESSAGES_PER_SECOND, burst: float = BURST) -> None:
        self._per_second = per_second
        self._burst = burst
        self._left = burst
        self._time = time.monotonic()

    @property
    def left(self) -> float:
        """How many messages may come at once; negative while some wait for their turn."""
        return self._left

    def take(self) -> float:
        """Spend one message; returns how long to wait for it [s]."""
        self._refill()
        self._left -= 1.0
        return max(0.0, -self._left / self._per_second)

    def spend(self) -> bool:
        """Spend one message if there is one left; there is no waiting for it."""
        self._refill()
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True

    def _refill(self) -> None:
        now = time.monotonic()
        self._left = min(self._burst, self._left + (now - self._time) * self._per_second)
        self._time = now


def _harden(headers: Headers) -> None:
    """No framing by other sites, no guessing of types, no telling others where one came from."""
    headers["X-Frame-Options"] = "SAMEORIGIN"
    headers["X-Content-Type-Options"] = "nosniff"
    headers["Referrer-Policy"] = "no-referrer"
