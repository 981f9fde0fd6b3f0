"""Starting and stopping viser's server with our socket and our guard in place of its own.

viser offers no way to pass either in, so its call of `websockets.serve` is exchanged while the server starts:
this is the one file (with `guard.py` and `filter.py`) to read again when viser changes.
"""

from __future__ import annotations

import asyncio
import logging
import socket
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import rich
import viser
import websockets.asyncio.server
from viser import _messages

from web.guard import LARGEST_MESSAGE, Guard, log
from web.listen import open_listener

TITLE = "tumble"

_exchange = threading.Lock()
_socket_log = logging.getLogger("tumble.web.socket")


class _OneLine(logging.Filter):
    """A client's broken handshake is its own affair: no traceback of it reaches a user."""

    def filter(self, record: logging.LogRecord) -> bool:
        record.exc_info, record.exc_text = None, None
        return record.levelno >= logging.CRITICAL


_socket_log.addFilter(_OneLine())


def start_server(host: str, port: int) -> tuple[viser.ViserServer, Guard]:
    """A server at exactly this address, which lets nobody in until `guard.open`. Raises ListenError."""
    listener = open_listener(host, port)
    guard = Guard(host)
    with _exchanged(guard, listener), _quiet():
        server = viser.ViserServer(host=host, port=listener.getsockname()[1], label=TITLE, verbose=False)
    # A client that has just left is no news, but viser warns of each message that it can no longer have.
    warnings.filterwarnings("ignore", message="Queued a .* on a closed connection", category=UserWarning)
    _remove_sharing(server)
    # The browser's tab would be called "Viser", among all its others.
    server._websock_server.queue_message(_messages.RunJavascriptMessage(f"document.title = {TITLE!r};"))
    server.get_event_loop().set_exception_handler(_log_loop_error)
    return server, guard


def stop_server(server: viser.ViserServer) -> None:
    with _quiet():
        server.stop()


@contextmanager
def _exchanged(guard: Guard, listener: socket.socket) -> Iterator[None]:
    original = websockets.asyncio.server.serve

    def serve(handler: Any, host: Any, port: Any, *, process_request: Any, max_size: Any, **rest: Any) -> Any:
        return original(
            guard.guarded(handler),
            sock=listener,
            process_request=guard.screened(process_request),
            max_size=LARGEST_MESSAGE,
            logger=_socket_log,
            **rest,
        )

    with _exchange:
        websockets.asyncio.server.serve = serve  # type: ignore[assignment, misc]
        try:
            yield
        finally:
            websockets.asyncio.server.serve = original  # type: ignore[misc]


@contextmanager
def _quiet() -> Iterator[None]:
    """The command line says in its own words where the page is."""
    original, rich.print = rich.print, lambda *_, **__: None
    try:
        yield
    finally:
        rich.print = original


def _remove_sharing(server: viser.ViserServer) -> None:
    """Any client could otherwise open a public tunnel to this machine. The filter refuses it too."""
    for message in (_messages.ShareUrlRequest, _messages.ShareUrlDisconnect):
        server._websock_server.unregister_handler(message)


def _log_loop_error(_: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    log.error("%s: %r", context.get("message"), context.get("exception"))
