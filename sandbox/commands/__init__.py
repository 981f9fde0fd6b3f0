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
from sandbox.commands.bodies import LARGEST_FRICTION, LARGEST_MASS, LARGEST_SPAWN, SIZES, Bomb, Spawn
from sandbox.commands.dragging import HANDS, Grab, MoveHand, Release
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
from sandbox.commands.settings import (
    LARGEST_GRAVITY,
    MOST_ITERATIONS,
    SWITCHES,
    SetGravity,
    SetIterations,
    SetSolver,
    SetSwitch,
)

__all__ = [
    "HANDS",
    "LARGEST_FRICTION",
    "LARGEST_GRAVITY",
    "LARGEST_MASS",
    "LARGEST_SPAWN",
    "MOST_ITERATIONS",
    "PHYSICS",
    "REACH",
    "SIZES",
    "SPEEDS",
    "SWITCHES",
    "Bomb",
    "Command",
    "Grab",
    "LoadScene",
    "MoveHand",
    "Pause",
    "PhysicsCommand",
    "Play",
    "Release",
    "Reset",
    "SetGravity",
    "SetIterations",
    "SetSolver",
    "SetSpeed",
    "SetSwitch",
    "Spawn",
    "StartRecording",
    "StepOnce",
    "StopRecording",
    "command_from_dict",
]

PHYSICS = {
    kind.name: kind
    for kind in (SetGravity, SetIterations, SetSwitch, SetSolver, Spawn, Bomb, Grab, MoveHand, Release)
}  # fmt: skip


def command_from_dict(values: Mapping[str, Any]) -> PhysicsCommand:
    """What `to_dict` gave; anything else is a ValueError."""
    if not isinstance(values, Mapping):
        raise validate.refuse("command", values, "a mapping of names to values")
    kind = PHYSICS[validate.choice("command", values.get("command"), PHYSICS)]
    arguments = {name: value for name, value in values.items() if name != "command"}
    known = {field.name for field in fields(kind)}
    if set(arguments) != known:
        raise validate.refuse(f"arguments of {kind.name}", sorted(arguments), f"exactly {sorted(known)}")
    return kind(**arguments)
