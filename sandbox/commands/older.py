"""Commands as older recordings hold them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields
from typing import Any

from sandbox.commands.spawn import Spawn

FIRST_SPAWN = ("shape", "x", "y", "width", "height", "mass", "friction", "count")  # what it had at first

ALL_SPAWN = {field.name for field in fields(Spawn)}


def modern(values: Mapping[str, Any]) -> Mapping[str, Any]:
    """What the same command is today; anything else as it is."""
    match values:
        case {"command": "set_gravity", "x": x, "y": y, **rest} if not rest:
            return {"command": "set", "setting": "gravity", "value": [x, y]}
        case {"command": "set_iterations", "iterations": iterations, **rest} if not rest:
            return {"command": "set", "setting": "iterations", "value": iterations}
        case {"command": "set_switch", "switch": switch, "on": on, **rest} if not rest:
            return {"command": "set", "setting": switch, "value": on}
        case {"command": "set_solver", "solver": solver, **rest} if not rest:
            return {"command": "set", "setting": "solver", "value": solver}
        case {"command": "spawn", **rest} if set(rest) in (set(FIRST_SPAWN), ALL_SPAWN - {"bullet"}):
            added = (field for field in fields(Spawn) if field.name not in rest)
            return {**values, **{field.name: field.default for field in added if field.default is not MISSING}}
    return values
