"""A client without a browser: it says whatever it likes, which is what the guard is for."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import msgspec
import viser
import zstandard
from websockets.sync.client import ClientConnection, connect

PROTOCOL = f"viser-v{viser.__version__}"
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": [0.0, 1.0, 0.0, 0.0],
    "position": [0.0, 5.0, 200.0],
    "fov": 0.1,
    "near": 1.0,
    "far": 5000.0,
    "image_height": 600,
    "image_width": 900,
    "look_at": [0.0, 5.0, 0.0],
    "up_direction": [0.0, 1.0, 0.0],
}
CLICK = {
    "type": "SceneNodeClickMessage",
    "name": "/pick",
    "instance_index": None,
    "ray_origin": [0.0, 5.0, 200.0],
    "ray_direction": [0.05, 0.01, -1.0],
    "screen_pos": [0.5, 0.5],
    "modifier": None,
    "owner": "",
}
DRAG = {
    "type": "SceneNodeDragMessage",
    "phase": "start",
    "name": "/pick",
    "instance_index": None,
    "start_position": [0.0, 0.5, 0.0],
    "start_screen_pos": [0.5, 0.5],
    "end_position": [1.0, 2.0, 0.0],
    "end_screen_pos": [0.5, 0.5],
    "button": "left",
    "modifier": None,
    "owner": "",
}


class RawClient:
    """One connection, after the server has told it all that there is on the page."""

    def __init__(self, socket: ClientConnection, url: str) -> None:
        self.socket = socket
        self.url = url
        self.messages: list[dict[str, Any]] = []
        self._seen = 0
        self.send(CAMERA)
        self.read_until("ReplayDoneMessage")

    def send(self, message: Any) -> None:
        self.socket.send(msgspec.msgpack.encode(message))

    def set(self, label: str, value: Any) -> None:
        self.send({"type": "GuiUpdateMessage", "uuid": self.control(label), "updates": {"value": value}})

    def control(self, label: str) -> str:
        """The id of the control or the command with this label."""
        for message in self.messages:
            is_control = message["type"] != "GuiFolderMessage"
            if is_control and (message.get("props") or {}).get("label") == label:
                return str(message["uuid"])
        raise LookupError(label)

    def read_until(self, kind: str, timeout: float = 5.0) -> dict[str, Any]:
        """The next message of this kind, after those that were looked at already."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            while self._seen < len(self.messages):
                self._seen += 1
                if self.messages[self._seen - 1]["type"] == kind:
                    return self.messages[self._seen - 1]
            self.read(timeout)
        raise TimeoutError(kind)

    def read(self, timeout: float = 5.0) -> list[dict[str, Any]]:
        raw = self.socket.recv(timeout)
        assert isinstance(raw, bytes)
        size = int.from_bytes(raw[8:16], "little")
        window = msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(raw[16 : 16 + size]))
        _fill_in(window["messages"], _buffers(raw, 16 + size, window["binaryBufferLengths"]))
        self.messages += window["messages"]
        return list(window["messages"])


def _buffers(raw: bytes, start: int, lengths: list[int]) -> list[bytes]:
    """The arrays that follow a window's messages, each from a multiple of eight bytes on."""
    buffers = []
    for length in lengths:
        start += -start % 8
        buffers.append(raw[start : start + length])
        start += length
    return buffers


def _fill_in(messages: list[dict[str, Any]], buffers: list[bytes]) -> None:
    """Put the arrays where the messages refer to them."""
    for message in messages:
        for values in (message.get("updates"), message.get("props")):
            for name, value in (values or {}).items():
                if isinstance(value, dict) and "__binary_index" in value:
                    values[name] = buffers[value["__binary_index"]]


@contextmanager
def raw_client(url: str, **options: Any) -> Iterator[RawClient]:
    options = {"subprotocols": [PROTOCOL], "max_size": None, "compression": None, "close_timeout": 1, **options}
    with connect(url.replace("http", "ws"), **options) as socket:
        yield RawClient(socket, url)
