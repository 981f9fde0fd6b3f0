"""Commands that join bodies, and take their joints away."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from engine import Body, validate
from engine.vec2 import Vec2, rotate
from sandbox.commands.base import REACH, PhysicsCommand, coordinates

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

JOINS = ("revolute", "distance", "prismatic", "weld", "wheel", "motor", "filter")  # a hand is the mouse joint already
POINT = -1  # in the place of a body: a point of the world that never moves
BODIES = 2**31
STIFFEST = 240.0  # of springs [1/s]: four times the usual steps
MOST_DAMPED = 10.0
FASTEST = 1e3  # of motors [rad/s], [m/s]
STRONGEST = 1e9  # [N], [N m]
AXES = ("prismatic", "wheel")
ANCHORS = ("revolute", "weld", *AXES)  # kinds with one anchor for both bodies
LIMITED = ("revolute", "distance", *AXES)  # kinds with limits, and with a motor
TURNED = ("revolute", "wheel")  # by their motors


@dataclass(frozen=True)
class Join(PhysicsCommand):
    """A joint between two bodies, by their places in the order of creation, and a point of each in its own frame [m].

    Places and not serials: those do not go back with a restored state. POINT: a point of the world, which a static body
    holds. A distance joint holds the two points, an axis goes from the first to the second, and other joints have the
    second for their anchor. hertz [1/s] and damping_ratio: of its spring, 0 for none. lower, upper: limits from how it
    is now, if limited [rad] or [m]. strength: of its motor, which goes at `speed` [rad/s] or [m/s], 0 for none; of a
    motor joint, 0 for any. break_force [N]: 0 for never. collide: whether the bodies do; with a point of the world all
    do.
    """

    kind: str
    body1: int
    x1: float
    y1: float
    body2: int
    x2: float
    y2: float
    hertz: float = 0.0
    damping_ratio: float = 0.7
    limited: bool = False
    lower: float = 0.0
    upper: float = 0.0
    speed: float = 0.0
    strength: float = 0.0
    break_force: float = 0.0
    collide: bool = False
    name = "join"

    def __post_init__(self) -> None:
        self._keep(
            kind=validate.choice("kind", self.kind, JOINS),
            body1=validate.whole("body1", self.body1, POINT, BODIES),
            body2=validate.whole("body2", self.body2, POINT, BODIES),
            hertz=validate.between("hertz", self.hertz, 0.0, STIFFEST),
            damping_ratio=validate.between("damping_ratio", self.damping_ratio, 0.0, MOST_DAMPED),
            limited=validate.switch("limited", self.limited),
            speed=validate.between("speed", self.speed, -FASTEST, FASTEST),
            strength=validate.between("strength", self.strength, 0.0, STRONGEST),
            break_force=validate.between("break_force", self.break_force, 0.0, STRONGEST),
            collide=validate.switch("collide", self.collide),
            **coordinates(x1=self.x1, y1=self.y1, x2=self.x2, y2=self.y2, lower=self.lower, upper=self.upper),
        )
        if self.lower > self.upper:
            raise validate.refuse("lower", self.lower, f"at most upper, which is {self.upper!r}")
        on_points = POINT in (self.body1, self.body2) if self.kind == "filter" else self.body1 == POINT == self.body2
        if on_points:
            raise validate.refuse("body2", self.body2, f"a body, where body1 is {self.body1} and the joint {self.kind}")

    def apply(self, simulation: Simulation) -> None:
        simulation.room_for_joint()
        world = simulation.world
        before = world.snapshot() if POINT in (self.body1, self.body2) else None
        try:
            self._create(simulation)
        except ValueError:
            if before is not None:  # the new static body was for nothing
                world.restore(before)
            raise

    def _create(self, simulation: Simulation) -> None:
        bodies = [_body(simulation, "body1", self.body1), _body(simulation, "body2", self.body2)]
        first = _anchor(self.body1, bodies[0], self.x1, self.y1)
        second = _anchor(self.body2, bodies[1], self.x2, self.y2)
        arguments: dict[str, Any] = {}
        if self.kind != "filter":
            arguments["collide_connected"] = self.collide or POINT in (self.body1, self.body2)
            arguments["break_force"] = self.break_force or None
        if self.kind in ANCHORS:
            arguments["anchor"] = second
        if self.kind in AXES:
            arguments["axis"] = second - first
        if self.kind == "distance":
            arguments.update(anchor1=first, anchor2=second)
        arguments.update(**self._spring(), **self._limits(first, second), **self._motor())
        getattr(simulation.world, f"create_joint_{self.kind}")(*bodies, **arguments)

    def _spring(self) -> dict[str, Any]:
        spring = {"hertz": self.hertz or None, "damping_ratio": self.damping_ratio}
        if self.kind in LIMITED:
            return spring
        sides = () if self.kind == "filter" else ("linear", "angular")
        return {f"{side}_{name}": value for side in sides for name, value in spring.items()}

    def _limits(self, first: Vec2, second: Vec2) -> dict[str, Any]:
        if not self.limited or self.kind not in LIMITED:
            return {}
        way = second - first
        length = float((way.x * way.x + way.y * way.y) ** 0.5) if self.kind == "distance" else 0.0
        least = 0.0 if self.kind == "distance" else -REACH
        return {"lower": max(least, length + self.lower), "upper": max(least, length + self.upper)}

    def _motor(self) -> dict[str, Any]:
        if self.kind == "motor":
            return {"max_force": self.strength or None, "max_torque": self.strength or None}
        if self.kind not in LIMITED or not self.strength:
            return {}
        return {"motor_speed": self.speed, f"max_motor_{strength_of(self.kind)}": self.strength}


@dataclass(frozen=True)
class Unjoin(PhysicsCommand):
    """All joints of a body, by its place in the order of creation, are taken away; of one not there, nothing."""

    body: int
    name = "unjoin"

    def __post_init__(self) -> None:
        self._keep(body=validate.whole("body", self.body, 0, BODIES))

    def apply(self, simulation: Simulation) -> None:
        bodies = simulation.world.bodies
        if self.body < len(bodies):
            for joint in simulation.world.joints:
                if bodies[self.body] in (joint.body1, joint.body2):
                    joint.destroy()


def strength_of(kind: str) -> str:
    """What the motor of a joint of this kind has a largest of."""
    return "torque" if kind in TURNED else "force"


def _body(simulation: Simulation, name: str, place: int) -> Body:
    if place == POINT:
        return simulation.anchor_body()
    bodies = simulation.world.bodies
    if place >= len(bodies):
        raise validate.refuse(name, place, f"{POINT} or the place of one of {len(bodies)} bodies")
    return bodies[place]


def _anchor(place: int, body: Body, x: float, y: float) -> Vec2:
    """A point of a body, or of the world, in the world [m]."""
    return Vec2(x, y) if place == POINT else body.position + rotate(body.direction, Vec2(x, y))
