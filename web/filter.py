"""Which messages of a browser reach viser: the few kinds the page needs, each field checked.

viser itself would store any attribute of any control, NaN included, so nothing unchecked may get that far.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import msgspec
import viser

LARGEST = 1e9  # no coordinate or number of the page comes near this
LONGEST_TEXT = 200  # characters
QUIET = frozenset({"FileTransferPartAck"})  # sent by every browser during a download, and needed by nobody

Message = dict[str, Any]
Check = Callable[[Any], bool]


class Refused(ValueError):
    """Why a message is ignored."""


def read_message(raw: bytes | str) -> Message:
    """The message in a websocket frame, decoded but not yet trusted."""
    if not isinstance(raw, bytes):
        raise Refused("a text frame")
    try:
        message = msgspec.msgpack.decode(raw)
    except (msgspec.MsgspecError, ValueError, RecursionError):
        raise Refused("not msgpack") from None
    if not isinstance(message, dict) or not isinstance(message.get("type"), str):
        raise Refused("a message without a type")
    return message


def check_message(message: Message, server: viser.ViserServer) -> None:
    """Raise Refused unless this message is one that the page sends, with values that its controls allow."""
    kind = message["type"]
    if kind == "GuiUpdateMessage":
        _check_fields(message, {"uuid": _is_text, "updates": _is_dict})
        _check_update(message, server)
    elif kind == "CommandTriggerMessage":
        _check_fields(message, {"uuid": _is_text})
        if message["uuid"] not in server.gui._command_handle_from_uuid:
            raise Refused("an unknown command")
    elif kind in _SCENE_FIELDS:
        _check_fields(message, _SCENE_FIELDS[kind])
        _check_scene(message, server)
    else:
        raise Refused(f"a message of kind {kind[:40]!r}")


def _check_fields(message: Message, fields: dict[str, Check]) -> None:
    kind = message["type"]
    if message.keys() - {"type"} != fields.keys():
        raise Refused(f"{kind} with wrong fields")
    for name, allowed in fields.items():
        if not allowed(message[name]):
            raise Refused(f"{kind}: {name} is {_shown(message[name])}")


def _check_scene(message: Message, server: viser.ViserServer) -> None:
    if "name" in message and server.scene.get_handle_by_name(message["name"]) is None:
        raise Refused(f"{message['type']} of an unknown object")
    if message["type"] == "ViewerCameraMessage" and message["look_at"] == message["position"]:
        raise Refused("a camera that looks nowhere")


def _check_update(message: Message, server: viser.ViserServer) -> None:
    handle = server.gui._gui_input_handle_from_uuid.get(message["uuid"])
    if handle is None:
        raise Refused("an unknown control")
    if message["updates"].keys() != {"value"}:
        raise Refused("something other than the value of a control")
    value, props = message["updates"]["value"], handle._impl.props
    if getattr(props, "disabled", False):
        raise Refused(f"{_label(props)}: this control is off")
    check = _VALUE_CHECKS.get(type(handle))
    if check is None:
        raise Refused(f"{_label(props)}: this control takes no value")
    if not check(value, handle._impl.value, props):
        raise Refused(f"{_label(props)}: {_shown(value)} is not allowed")


def _label(props: Any) -> str:
    return str(getattr(props, "label", "") or "control")


def _shown(value: Any) -> str:
    """Foreign text, safe and short enough for a log."""
    return ascii(value)[:60]


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and len(value) <= LONGEST_TEXT


def _is_dict(value: Any) -> bool:
    return isinstance(value, dict)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST  # False for NaN


def _is_count(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 100_000


def _numbers(count: int) -> Check:
    return lambda value: isinstance(value, list) and len(value) == count and all(map(_is_number, value))


def _one_of(*options: Any) -> Check:
    return lambda value: any(value is option or (isinstance(value, str) and value == option) for option in options)


def _or_none(check: Check) -> Check:
    return lambda value: value is None or check(value)


def _within(value: Any, current: Any, props: Any) -> bool:
    """A number within the control's own limits; a control of whole numbers takes only those."""
    if not _is_number(value) or (isinstance(current, int) and value != math.floor(value)):
        return False
    low, high = props.min, props.max
    return (low is None or value >= low) and (high is None or value <= high)


def _is_option(value: Any, _: Any, props: Any) -> bool:
    return isinstance(value, str) and value in props.options


def _is_switch(value: Any, *_: Any) -> bool:
    return isinstance(value, bool)


_VALUE_CHECKS: dict[type, Callable[[Any, Any, Any], bool]] = {
    viser.GuiSliderHandle: _within,
    viser.GuiNumberHandle: _within,
    viser.GuiCheckboxHandle: _is_switch,
    viser.GuiButtonHandle: _is_switch,
    viser.GuiDropdownHandle: _is_option,
    viser.GuiButtonGroupHandle: _is_option,
}

_POINT, _PIXEL = _numbers(3), _numbers(2)
_SCENE_FIELDS: dict[str, dict[str, Check]] = {
    "ViewerCameraMessage": {
        "wxyz": _numbers(4),
        "position": _POINT,
        "fov": _is_number,
        "near": _is_number,
        "far": _is_number,
        "image_height": _is_count,
        "image_width": _is_count,
        "look_at": _POINT,
        "up_direction": _POINT,
    },
    "SceneNodeClickMessage": {
        "name": _is_text,
        "instance_index": _or_none(_is_count),
        "ray_origin": _POINT,
        "ray_direction": _POINT,
        "screen_pos": _PIXEL,
        "modifier": _or_none(_is_text),
        "owner": _is_text,
    },
    "SceneNodeDragMessage": {
        "phase": _one_of("start", "update", "end"),
        "name": _is_text,
        "instance_index": _or_none(_is_count),
        "start_position": _POINT,
        "start_screen_pos": _PIXEL,
        "end_position": _POINT,
        "end_screen_pos": _PIXEL,
        "button": _one_of("left", "middle", "right"),
        "modifier": _or_none(_is_text),
        "owner": _is_text,
    },
}
