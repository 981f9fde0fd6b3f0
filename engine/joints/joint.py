"""What all kinds of joints share: the handle that a user holds, and how a joint comes into a world."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine import validate
from engine.joints.fields import FAR, Most, Number, acts, clear_idle
from engine.solvers import SOLVERS
from engine.tables import ALONG_WAY, HELD, JOINT_KINDS, NEVER, NO_SPRING, NOTHING, SPRING, STIFF, rounded_up
from engine.trigonometry import cos_sin
from engine.vec2 import Vec2, unrotate

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World

Pair = tuple[float, float]


class Joint:
    """A joint of a world. Reading or changing one that was destroyed is a ValueError."""

    __slots__ = ("__weakref__", "_row", "serial", "world")

    kind: ClassVar[str] = ""  # one of JOINT_KINDS

    break_force = Most("joints", "break_force", "Beyond this force it breaks for good [N]; None: never.")
    break_torque = Most("joints", "break_torque", "Beyond this torque it breaks for good [N m]; None: never.")

    def __init__(self, world: World, row: int, serial: int) -> None:
        self.world = world
        self.serial = serial  # number of creation among the joints, from 0, never given twice
        self._row = row

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Joint) and other.world is self.world and other.serial == self.serial

    def __hash__(self) -> int:
        return hash((id(self.world), "joint", self.serial))

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.serial}{'' if self.alive else ', destroyed'}>"

    @property
    def alive(self) -> bool:
        """Whether it is still in its world."""
        return self.world._state.joints.holds(self._row, self.serial)

    def destroy(self) -> None:
        """Takes the joint out of the world."""
        self._check()
        self.world._destroy_joint(self._row)

    @property
    def body1(self) -> Body:
        return self.world._body_in_row(int(self._part("joints")["body1"]))

    @property
    def body2(self) -> Body:
        return self.world._body_in_row(int(self._part("joints")["body2"]))

    @property
    def anchors(self) -> tuple[Vec2, Vec2]:
        """The anchor of body1 and that of body2, in the world [m]."""
        row = self._record
        return Vec2(float(row["x1"]), float(row["y1"])), Vec2(float(row["x2"]), float(row["y2"]))

    @property
    def impulse(self) -> Vec2:
        """What the last step gave body2 at its anchor, and body1 the other way [N s]."""
        return Vec2(float(self._record["impulse_x"]), float(self._record["impulse_y"]))

    @property
    def force(self) -> Vec2:
        """The same over the step's time: the force that it held body2 with, on average [N]."""
        impulse, dt = self.impulse, self.world._state.last_dt
        return impulse * (1.0 / dt) if dt > 0.0 else Vec2(0.0, 0.0)

    @property
    def torque(self) -> float:
        """What turned body2, and body1 the other way, on average [N m]."""
        impulse, dt = float(self._record["turn_impulse"]), self.world._state.last_dt
        return impulse / dt if dt > 0.0 else 0.0

    @property
    def collide_connected(self) -> bool:
        """Whether its two bodies collide with each other."""
        return bool(self._part("joints")["collide_connected"])

    def _check(self) -> None:
        if not self.alive:
            raise ValueError(
                f"joint = {type(self).__name__} {self.serial}: must be a living joint, this one was destroyed"
            )

    @property
    def _record(self) -> Any:
        self._check()
        return self.world._joint_record(self._row)

    def _part(self, table: str) -> Any:
        """Its row in one of the tables of joints."""
        self._check()
        return self.world._state.joints.tables[table][self._row]

    def _write(self, table: str, values: dict[str, Any]) -> None:
        """Writes what was checked, and lets the world know."""
        part = self._part(table)
        if table != "joints":
            refuse_parts(self.world, values)
        before = structure(part, table)
        for name, value in values.items():
            part[name] = value
        if table != "joints":
            settle(part, self.along)
        self.world._joint_changed(self._row, structure(part, table) != before)

    along: ClassVar[int] = 1  # of its slide


def structure(part: Any, table: str) -> tuple:
    """What of a joint decides which rows it has, which tables are there, and whether it is solved with others at once.

    Of a motor's strength no more than its power of two: who sets it in each step pays for that in few of them.
    """
    if table == "joints":
        names = ("break_force", "break_torque", "max_force", "bias_factor")
        rigid = part["hertz"] == 0.0 and part["softness"] == 0.0
        return (rigid, *(part[name] >= 0.0 for name in names))
    strength = float(rounded_up(part["max_motor"])) if part["motored"] else 0.0
    return (strength, *(int(part[name]) for name in ("along", "spring", "motored", "limited")))


def settle(part: Any, along: int) -> None:
    """A turn or slide is there while anything acts in it; a way without spring, limits and motor is a rod."""
    if along == ALONG_WAY and part["spring"] != SPRING:
        part["spring"] = NO_SPRING if part["motored"] or part["limited"] else STIFF
    part["along"] = along if acts(part) else 0
    clear_idle(part)


def checked_pair(world: World, body1: Any, body2: Any) -> None:
    """ValueError unless both are living bodies of the world, and a joint can do something with them."""
    for name, body in (("body1", body1), ("body2", body2)):
        check_body(world, name, body)
    if body1 == body2:
        raise validate.refuse("body2", body2, "another body than body1")
    if body1.kind != "dynamic" and body2.kind != "dynamic":
        raise validate.refuse("body2", body2, f"dynamic where body1 is {body1.kind}")


def check_body(world: World, name: str, body: Any) -> Body:
    """A living body of this world."""
    from engine.bodies import Body

    if not isinstance(body, Body):
        raise validate.refuse(name, body, "a body of this world")
    if body.world is not world:
        raise validate.refuse(name, body, "a body of this world, not of another")
    if not body.alive:
        raise validate.refuse(name, body, "a living body, this one was destroyed")
    return body


def anchored(number: int, body: Body, point: Pair | Vec2, name: str = "anchor") -> dict[str, float]:
    """The columns of an anchor, from a point of the world [m], which is refused by its name if it is too far away."""
    c, s = cos_sin(body.angle)
    local = unrotate(Vec2(c, s), Vec2(*point) - body.position)
    if not max(abs(local.x), abs(local.y)) <= FAR:
        raise validate.refuse(name, tuple(point), f"within {FAR:g} m of body{number}")
    return {f"anchor{number}_x": local.x, f"anchor{number}_y": local.y}


def axis_of(body1: Body, axis: Any) -> dict[str, float]:
    """The columns of an axis, from a direction in the world."""
    x, y = validate.vector("axis", axis)
    length = float(np.hypot(x, y))
    if not np.isfinite(length) or length < 1e-300:
        raise validate.refuse("axis", axis, "a direction (x, y) that is not (0, 0)")
    local = unrotate(Vec2(*cos_sin(body1.angle)), Vec2(x / length, y / length))
    return {"axis_x": local.x, "axis_y": local.y}


def add(
    world: World,
    kind: type[Joint],
    body1: Body,
    body2: Body,
    held: int,
    collide_connected: bool,
    break_force: float | None,
    break_torque: float | None,
    joint: dict[str, Any],
    turn: dict[str, Any] | None = None,
    slide: dict[str, Any] | None = None,
) -> Any:
    """Writes the rows of a joint, all of which is checked here or was; held: index into HELD."""
    effect = f"{kind.kind} joints"
    if effect in SOLVERS[world.solver].lacks:
        raise validate.refuse("solver", world.solver, f"one that knows {effect}")
    refuse_parts(world, turn, slide)
    values = {
        "kind": JOINT_KINDS.index(kind.kind),
        "held": held,
        "body1": body1._row,
        "body2": body2._row,
        "max_force": NEVER,
        "bias_factor": -1.0,
        "collide_connected": validate.switch("collide_connected", collide_connected),
        **Joint.break_force.written(world.precision, break_force),
        **Joint.break_torque.written(world.precision, break_torque),
        **joint,
    }
    storage = world._state.joints
    row = storage.add()
    for table, written in (("joints", values), ("turns", turn or {}), ("slides", slide or {})):
        part = storage.tables[table]
        for name, value in written.items():
            part[name][row] = value
        if table != "joints":
            if "max_spring" not in written:
                part["max_spring"][row] = NEVER
            settle(part[row], kind.along if table == "slides" else 1)
    world._joined(row)
    return kind(world, row, int(storage.tables["joints"]["serial"][row]))


PARTS = (
    ("spring", "hertz", "joint springs"),
    ("motored", "motor_speed", "joint motors"),
    ("limited", "lower", "joint limits"),
)
"""Columns of a turn or slide: what tells that there is one, what is told of it if it is refused, the effect."""


def refuse_parts(world: World, *parts: dict[str, Any] | None) -> None:
    """ValueError if the solver lacks springs, motors or limits of joints, and one is wanted."""
    lacks = SOLVERS[world.solver].lacks
    for part in parts:
        for field, name, effect in PARTS:
            if part and part.get(field) and effect in lacks:
                raise validate.refuse(name, part.get(name), f"None with the solver {world.solver!r}")


assert HELD[NOTHING] == "nothing"

__all__ = ["Joint", "Number", "add", "anchored", "axis_of", "checked_pair"]
