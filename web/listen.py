"""Opening the port ourselves: viser would silently take the next free one."""

from __future__ import annotations

import errno
import socket


class ListenError(Exception):
    """The page cannot be served at this address; the message is one clear line."""


class PortInUse(ListenError):
    """Another program listens on this port already."""


def open_listener(host: str, port: int) -> socket.socket:
    """A listening socket at exactly this address; port 0 asks for any free one."""
    if not 0 <= port <= 65535:
        raise ListenError(f"port is {port}; allowed: 0 (any free one) to 65535")
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
        return socket.create_server(address, family=family)
    except OSError as error:
        raise _explained(error, host, port) from None


def page_url(host: str, port: int) -> str:
    """The address to open in a browser; "every interface" is not one, so it becomes this machine."""
    if host in ("", "0.0.0.0", "::"):
        host = "127.0.0.1"
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"


def _explained(error: OSError, host: str, port: int) -> ListenError:
    if error.errno == errno.EADDRINUSE:
        return PortInUse(f"port {port} on {host} is already in use; choose another one with --port")
    if error.errno in (errno.EACCES, errno.EPERM):
        return ListenError(f"port {port} needs more rights than this user has; choose one above 1023 with --port")
    return ListenError(f"cannot listen on {host}, port {port}: {error.strerror or error}")
