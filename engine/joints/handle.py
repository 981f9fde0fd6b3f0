"""Joints: the handle that a user holds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from engine import validate
from engine.vec2 import Vec2

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class RevoluteJoint:
    """A revolute joint of a world. Reading or changing one that was destroyed is a ValueError."""

    __slots__ = ("__weakref__", "_row", "serial", "world")

    def __init__(self, world: World, row: int, serial: int) -> None:
        self.world = world
        self.serial = serial  # number of creation among the joints, from 0, never given twice
        self._row = row

    def __eq__(self, other: object) -> bool:
        return isinstance(other, RevoluteJoint) and other.world is self.world and other.serial == self.serial

    def __hash__(self) -> int:
        return hash((id(self.world), "joint", self.serial))

    def __repr__(self) -> str:
        return f"<RevoluteJoint {self.serial}{'' if self.alive else ', destroyed'}>"

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
        return self.world._body_in_row(int(self._joint["body1"]))

    @property
    def body2(self) -> Body:
        return self.world._body_in_row(int(self._joint["body2"]))

    @property
    def impulse(self) -> Vec2:
        """What the last step gave body2 through the joint, and body1 the other way [N s]."""
        return Vec2(float(self._joint["given_x"]), float(self._joint["given_y"]))

    @property
    def anchors(self) -> tuple[Vec2, Vec2]:
        """The anchor of body1 and that of body2, in the world [m]: one point if the joint holds."""
        self._check()
        record = self.world.joint_records()
        row = record[record["joint"] == self.serial][0]
        return Vec2(float(row["x1"]), float(row["y1"])), Vec2(float(row["x2"]), float(row["y2"]))

    @property
    def softness(self) -> float:
        """How far it gives way [1/kg]."""
        return float(self._joint["softness"])

    @softness.setter
    def softness(self, value: float) -> None:
        softness = validate.non_negative("softness", value)
        validate.in_range(self.world.precision, softness=(softness,))
        self._joint["softness"] = softness

    @property
    def bias_factor(self) -> float | None:
        """Part of the separation that a step removes, 0 to 1; None: the solver's own."""
        factor = float(self._joint["bias_factor"])
        return None if factor < 0.0 else factor

    @bias_factor.setter
    def bias_factor(self, value: float | None) -> None:
        factor = -1.0 if value is None else validate.between("bias_factor", value, 0.0, 1.0)
        self._joint["bias_factor"] = factor

    @property
    def collide_connected(self) -> bool:
        """Whether its two bodies collide with each other."""
        return bool(self._joint["collide_connected"])

    @property
    def motor_speed(self) -> float | None:
        """At which the motor turns body2 over body1 [rad/s]; None: there is no motor."""
        return self._motor("motor_speed") if self._motor("motored") else None

    @motor_speed.setter
    def motor_speed(self, value: float | None) -> None:
        had = bool(self._motor("motored"))
        self._set_motor(value, self.max_motor_torque)
        if (value is not None) != had:
            self.world._content_changed()

    @property
    def max_motor_torque(self) -> float:
        """Of the motor [N m]."""
        return self._motor("max_motor_torque")

    @max_motor_torque.setter
    def max_motor_torque(self, value: float) -> None:
        self._set_motor(self.motor_speed, value)

    @property
    def motor_torque(self) -> float:
        """What the last step's motor gave body2, and body1 the other way, on average [N m]."""
        dt = self.world._state.last_dt
        return self._motor("motor_given") / dt if dt > 0.0 else 0.0

    def _motor(self, name: str) -> float:
        self._check()
        return float(self.world._state.joints.get(name, self._row))

    def _set_motor(self, speed: float | None, torque: float) -> None:
        self._check()
        for name, value in checked_motor(self.world.precision, speed, torque).items():
            self.world._state.joints.put(name, self._row, value)

    def _check(self) -> None:
        if not self.alive:
            raise ValueError(f"joint = RevoluteJoint {self.serial}: must be a living joint, this one was destroyed")

    @property
    def _joint(self) -> Any:
        self._check()
        return self.world._state.joints.tables["joints"][self._row]


def checked_motor(precision: str, speed: float | None, torque: float) -> dict[str, float]:
    """A motor's columns. ValueError names what cannot be; without a speed there is none, and nothing that it gave."""
    torque = validate.non_negative("max_motor_torque", torque)
    validate.in_range(precision, max_motor_torque=(torque,))
    if speed is None:
        return {"motored": 0, "motor_speed": 0.0, "max_motor_torque": torque, "motor_impulse": 0.0, "motor_given": 0.0}
    speed = validate.number("motor_speed", speed, "a finite number, or None")
    validate.in_range(precision, motor_speed=(speed,))
    return {"motored": 1, "motor_speed": speed, "max_motor_torque": torque}
