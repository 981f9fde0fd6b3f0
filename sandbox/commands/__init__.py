"""What may be asked of a simulation, as checked, immutable data: a page, a script and a recording all say it so.

A command is validated when it is made: ValueError names the argument, its value and what is allowed. Those with a name
in PHYSICS change the world; they are recorded with the step before which they were applied, and make a recording of a
lively session repeatable.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from engine import validate
from sandbox.commands.base import REACH, Command, PhysicsCommand
from sandbox.commands.bomb import Bomb
from sandbox.commands.dragging import HANDS, Grab, MoveHand, Release
from sandbox.commands.driving import DriveMotor
from sandbox.commands.joints import JOINS, LIMITED, POINT, Join, Unjoin, strength_of
from sandbox.commands.older import modern
from sandbox.commands.session import (
    SPEEDS,
    LoadScene,
    Pause,
    Play,
    Reset,
    SetSpeed,
    StartRecording,
    StepOnce,
    StopRecording,
)
from sandbox.commands.settings import Set, SetAll
from sandbox.commands.spawn import CORNERS, KINDS, LINES, SIZES, Spawn

__all__ = [
    "CORNERS",
    "HANDS",
    "JOINS",
    "KINDS",
    "LIMITED",
    "LINES",
    "PHYSICS",
    "POINT",
    "REACH",
    "SIZES",
    "SPEEDS",
    "Bomb",
    "Command",
    "DriveMotor",
    "Grab",
    "Join",
    "LoadScene",
    "MoveHand",
    "Pause",
    "PhysicsCommand",
    "Play",
    "Release",
    "Reset",
    "Set",
    "SetAll",
    "SetSpeed",
    "Spawn",
    "StartRecording",
    "StepOnce",
    "StopRecording",
    "Unjoin",
    "command_from_dict",
    "modern",
    "strength_of",
]

PHYSICS = {kind.name: kind for kind in (Set, SetAll, Spawn, Bomb, Grab, MoveHand, Release, DriveMotor, Join, Unjoin)}


def command_from_dict(values: Mapping[str, Any]) -> PhysicsCommand:
    """What `to_dict` gave, or gave in an older version; anything else is a ValueError."""
    if not isinstance(values, Mapping):
        raise validate.refuse("command", values, "a mapping of names to values")
    values = modern(values)
    kind = PHYSICS[validate.choice("command", values.get("command"), PHYSICS)]
    arguments = {name: value for name, value in values.items() if name != "command"}
    known = {field.name for field in fields(kind)}
    if set(arguments) != known:
        raise validate.refuse(f"arguments of {kind.name}", sorted(arguments), f"exactly {sorted(known)}")
    return kind(**arguments)
