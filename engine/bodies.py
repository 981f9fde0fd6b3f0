"""Bodies: the handle that a user holds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from engine import validate
from engine.constants import FRICTION
from engine.effects import BODY_PROPERTIES
from engine.integrate import place_rows
from engine.properties import Part
from engine.queries import rows_at
from engine.shape_handle import ShapeHandle
from engine.shapes import Shape
from engine.sleeping import asleep_of, hush, touch, touch_weights
from engine.tables import BODY_KINDS, STATIC
from engine.vec2 import Vec2, cross
from engine.weights import reweigh

if TYPE_CHECKING:
    from engine.world import World

Pair = Sequence[float]


class Body(Part):
    """A body of a world. Reading or changing one that was destroyed is a ValueError.

    Vectors are given back as `Vec2`: a pair (x, y) that also adds, subtracts and scales.
    """

    __slots__ = ("__weakref__", "_row", "serial", "world")

    properties = BODY_PROPERTIES
    noun = "body"

    if TYPE_CHECKING:
        linear_damping: float
        angular_damping: float
        gravity_scale: float
        drag: float
        magnet: float
        can_sleep: bool
        attraction: float
        bullet: bool

    def __init__(self, world: World, row: int, serial: int) -> None:
        self.world = world
        self.serial = serial  # number of creation, from 0, never given twice
        self._row = row

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Body) and other.world is self.world and other.serial == self.serial

    def __hash__(self) -> int:
        return hash((id(self.world), self.serial))

    def __repr__(self) -> str:
        if not self.alive:
            return f"<Body {self.serial}, destroyed>"
        what = self.shape if self.shapes else "without a shape"
        return f"<Body {self.serial}: {self.kind} {what} at ({self.position.x:g}, {self.position.y:g})>"

    @property
    def alive(self) -> bool:
        """Whether it is still in its world."""
        return self.world._state.bodies.holds(self._row, self.serial)

    def destroy(self) -> None:
        """Takes the body, its contacts and its joints out of the world."""
        self._check()
        self.world._destroy_body(self)

    # --- what it is ---------------------------------------------------------------------------------------------

    @property
    def kind(self) -> str:
        """One of BODY_KINDS."""
        return BODY_KINDS[int(self._body["kind"])]

    @property
    def shapes(self) -> list[ShapeHandle]:
        """Its shapes in the order of creation."""
        self._check()
        return self.world._shapes_of(self._row)

    @property
    def shape(self) -> Shape:
        """Its first shape. ValueError if it has none."""
        return self._first_shape().shape

    def add_shape(
        self,
        shape: Shape,
        *,
        mass: float | None = None,
        density: float | None = None,
        friction: float = FRICTION,
        offset: Pair = (0.0, 0.0),
        angle: float = 0.0,
        **properties: Any,
    ) -> ShapeHandle:
        """One shape more, whose place in the body's frame is offset [m] and angle [rad]; mass and centre follow.

        mass [kg], or density [kg/m^2], 1 if neither is given; friction: coefficient >= 0; properties of shapes as in
        World.create_body.
        """
        self._check()
        return self.world._add_shape(self, shape, mass, density, friction, offset, angle, properties)

    @property
    def mass(self) -> float:
        """[kg], infinite for a body that no force moves."""
        return float(self._body["mass"])

    @property
    def inertia(self) -> float:
        """About the centre of mass [kg m^2], infinite for a static body."""
        return float(self._body["inertia"])

    @property
    def inverse_mass(self) -> float:
        """[1/kg], 0 for a static body."""
        return float(self._motion["inverse_mass"])

    @property
    def inverse_inertia(self) -> float:
        """[1/(kg m^2)], 0 for a static body."""
        return float(self._motion["inverse_inertia"])

    @property
    def friction(self) -> float:
        """Coefficient of its first shape; set, of all its shapes."""
        return self._first_shape().friction

    @friction.setter
    def friction(self, value: float) -> None:
        for shape in self.shapes:
            shape.friction = value

    @property
    def fixed_rotation(self) -> bool:
        """Whether nothing turns it."""
        return bool(self._body["fixed_rotation"])

    @fixed_rotation.setter
    def fixed_rotation(self, value: bool) -> None:
        fixed = validate.switch("fixed_rotation", value)
        self._touch()
        self._body["fixed_rotation"] = fixed
        if fixed and self.kind == "dynamic":
            self._motion["w"] = 0.0
        reweigh(self.world._state, self._row)
        self.world._content_changed()

    # --- how it moves -------------------------------------------------------------------------------------------

    @property
    def position(self) -> Vec2:
        """Of its origin [m]: where it was created."""
        return Vec2(float(self._body["x"]), float(self._body["y"]))

    @position.setter
    def position(self, value: Pair) -> None:
        body = self._body
        body["x"], body["y"] = validate.vector("position", value)
        self._place()

    @property
    def center(self) -> Vec2:
        """Its centre of mass [m]."""
        return Vec2(float(self._body["center_x"]), float(self._body["center_y"]))

    @property
    def angle(self) -> float:
        """Unwrapped [rad]."""
        return float(self._body["angle"])

    @angle.setter
    def angle(self, value: float) -> None:
        self._body["angle"] = validate.number("angle", value)
        self._place()

    rotation = angle  # the talk's word for it

    @property
    def direction(self) -> Vec2:
        """Cosine and sine of the angle, the same on every machine; coarser in single precision."""
        motion = self._motion
        return Vec2(float(motion["cosine"]), float(motion["sine"]))

    @property
    def velocity(self) -> Vec2:
        """Of the centre of mass [m/s]."""
        return Vec2(float(self._motion["vx"]), float(self._motion["vy"]))

    @velocity.setter
    def velocity(self, value: Pair) -> None:
        x, y = validate.vector("velocity", value)
        validate.in_range(self.world.precision, velocity=(x, y))
        motion = self._movable("velocity", value)
        self._touch()
        motion["vx"], motion["vy"] = x, y

    @property
    def angular_velocity(self) -> float:
        """[rad/s]"""
        return float(self._motion["w"])

    @angular_velocity.setter
    def angular_velocity(self, value: float) -> None:
        w = validate.number("angular_velocity", value)
        validate.in_range(self.world.precision, angular_velocity=(w,))
        motion = self._movable("angular_velocity", value)
        if w != 0.0 and self.fixed_rotation and self.kind == "dynamic":
            raise validate.refuse("angular_velocity", value, "zero: the body's rotation is fixed")
        self._touch()
        motion["w"] = w

    @property
    def force(self) -> Vec2:
        """Acts during the next step, then it is used up [N]."""
        return Vec2(float(self._body["force_x"]), float(self._body["force_y"]))

    @force.setter
    def force(self, value: Pair) -> None:
        force = validate.vector("force", value)
        validate.in_range(self.world.precision, force=force)
        body = self._body
        self._touch()
        body["force_x"], body["force_y"] = force

    @property
    def torque(self) -> float:
        """Acts during the next step, then it is used up [N m]."""
        return float(self._body["torque"])

    @torque.setter
    def torque(self, value: float) -> None:
        torque = validate.number("torque", value)
        validate.in_range(self.world.precision, torque=(torque,))
        body = self._body
        self._touch()
        body["torque"] = torque

    @property
    def awake(self) -> bool:
        """Whether it is not asleep: steps move it. True wakes its island, which has then not been still so far.

        False stops its island: velocities become zero, and it falls asleep in the next step, unless something in it may
        not. ValueError where there is nothing that may sleep.
        """
        self._check()
        asleep = asleep_of(self.world._state)
        return asleep is None or not asleep[self._row]

    @awake.setter
    def awake(self, value: bool) -> None:
        if validate.switch("awake", value):
            self._check()
            self._touch()
        elif self.kind != "dynamic" or not self.inverse_mass:
            raise validate.refuse("awake", value, "True: only a dynamic body that weighs something sleeps")
        elif not self.world.may_sleep:
            raise validate.refuse("awake", value, "True where sleeping is off, or the solver knows none")
        else:
            hush(self.world._state, self._row)

    def contains(self, point: Pair) -> bool:
        """Whether a point of the world [m] lies in the body."""
        x, y = validate.vector("point", point)
        self._check()
        return self._row in rows_at(self.world._state, x, y)

    def velocity_at(self, point: Pair) -> Vec2:
        """Velocity of the material point that is now at `point` in the world [m/s]."""
        px, py = validate.vector("point", point)
        w, v, r = self.angular_velocity, self.velocity, Vec2(px, py) - self.center
        return Vec2(v.x - w * r.y, v.y + w * r.x)

    def apply_force(self, force: Pair, point: Pair | None = None) -> None:
        """Adds a force [N] for the next step, at a point of the world [m] or at the centre of mass."""
        fx, fy, arm = self._lever("force", force, point)
        body = self._body
        total = (body["force_x"] + fx, body["force_y"] + fy, body["torque"] + cross(arm, Vec2(fx, fy)))
        validate.in_range(self.world.precision, force=total)
        self._touch()
        body["force_x"], body["force_y"], body["torque"] = total

    def apply_impulse(self, impulse: Pair, point: Pair | None = None) -> None:
        """Changes the velocity at once by an impulse [N s], at a point of the world [m] or at the centre of mass.

        Static and kinematic bodies do not feel it.
        """
        px, py, arm = self._lever("impulse", impulse, point)
        vx, vy = self.velocity
        changed = (
            vx + self.inverse_mass * px,
            vy + self.inverse_mass * py,
            self.angular_velocity + self.inverse_inertia * cross(arm, Vec2(px, py)),
        )
        validate.in_range(self.world.precision, impulse=changed)
        self._touch()
        motion = self._motion
        motion["vx"], motion["vy"], motion["w"] = changed

    # --- inside -------------------------------------------------------------------------------------------------

    def _lever(self, name: str, value: Pair, point: Pair | None) -> tuple[float, float, Vec2]:
        """A checked vector, and the way from the centre of mass to where it acts."""
        x, y = validate.vector(name, value)
        center = self.center
        if point is None:
            return x, y, Vec2(0.0, 0.0)
        px, py = validate.vector("point", point)
        return x, y, Vec2(px, py) - center

    def _first_shape(self) -> ShapeHandle:
        shapes = self.shapes
        if not shapes:
            raise ValueError(f"body = Body {self.serial}: must have a shape")
        return shapes[0]

    @property
    def _storage(self) -> Any:
        return self.world._state.bodies

    @property
    def _places(self) -> int:
        return self._row

    @property
    def _body(self) -> Any:
        self._check()
        return self.world._state.bodies.tables["bodies"][self._row]

    @property
    def _motion(self) -> Any:
        self._check()
        return self.world._state.bodies.tables["motions"][self._row]

    def _touch(self) -> None:
        """Something is done to it: see engine/sleeping.py."""
        touch(self.world._state, self._row)

    def _touch_property(self) -> None:
        """A property of its own is set: what lies on it does not feel that."""
        touch_weights(self.world._state, np.array([self._row]))

    def _movable(self, name: str, value: Any) -> Any:
        if int(self._body["kind"]) == STATIC:
            raise validate.refuse(name, value, "left alone: the body is static")
        return self._motion

    def _place(self) -> None:
        """Takes sine, cosine and centre of mass afresh after the pose was set."""
        self._touch()
        tables = self.world._state.bodies.tables
        place_rows(tables["bodies"], tables["motions"], np.array([self._row]))
