"""Making bodies and joints: everything is checked first, then written, so that a refusal changes nothing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from engine import validate
from engine.bodies import Body, Pair
from engine.constants import DENSITY, JOINT_BIAS_FACTOR
from engine.joints.handle import RevoluteJoint
from engine.shapes import SHAPES, Shape
from engine.tables import BODY_KINDS, REALS
from engine.trigonometry import cos_sin
from engine.vec2 import Vec2, unrotate

if TYPE_CHECKING:
    from engine.world import World


def mass_properties(
    shape: Shape, kind: str, mass: float | None, density: float | None, precision: str
) -> tuple[float, float, float, float]:
    """Mass [kg], inertia [kg m^2] and their inverses, all checked; infinite and zero for a static body."""
    if mass is not None and density is not None:
        raise validate.refuse("density", density, "left out where mass is given")
    if mass is not None:
        mass = validate.positive("mass", mass)
    else:
        mass = validate.positive("density", DENSITY if density is None else density) * shape.area
    if kind == "static":
        return math.inf, math.inf, 0.0, 0.0
    inertia = shape.inertia(mass)
    # a joint multiplies two inverse masses: their product, too, must be a normal number
    low = math.sqrt(float(np.finfo(REALS[precision]).tiny))
    for name, value in (("mass", mass), ("inertia", inertia)):
        if not low < value < 1.0 / low:
            raise validate.refuse(name, value, f"from {low:.2g} to {1.0 / low:.2g} in {precision} precision")
    return mass, inertia, 1.0 / mass, 1.0 / inertia


def add_body(
    world: World,
    shape: Shape,
    position: Pair,
    angle: float,
    kind: str,
    mass: float | None,
    density: float | None,
    friction: float,
    velocity: Pair,
    angular_velocity: float,
) -> Body:
    """Checks everything, then writes the body's rows: World.create_body says what the arguments mean."""
    if not isinstance(shape, SHAPES):
        raise validate.refuse("shape", shape, "a " + " or a ".join(cls.__name__ for cls in SHAPES))
    kind = validate.choice("kind", kind, BODY_KINDS)
    x, y = validate.vector("position", position)
    angle = validate.number("angle", angle)
    friction = validate.non_negative("friction", friction)
    vx, vy = validate.vector("velocity", velocity)
    w = validate.number("angular_velocity", angular_velocity)
    half_x, half_y = shape.half_extents
    validate.in_range(world.precision, shape=(half_x, half_y))
    validate.in_range(world.precision, velocity=(vx, vy), angular_velocity=(w,), friction=(friction,))
    if kind == "static" and (vx != 0.0 or vy != 0.0 or w != 0.0):
        raise validate.refuse("velocity", (vx, vy, w), "zero for a static body")
    mass, inertia, inverse_mass, inverse_inertia = mass_properties(shape, kind, mass, density, world.precision)

    storage = world._state.bodies
    row = storage.add()
    body, motion = storage.tables["bodies"][row], storage.tables["motions"][row]
    for name, value in {
        "x": x, "y": y, "angle": angle, "mass": mass, "inertia": inertia, "friction": friction,
        "half_x": half_x, "half_y": half_y, "kind": BODY_KINDS.index(kind), "shape_kind": shape.kind,
    }.items():  # fmt: skip
        body[name] = value
    for name, value in {
        "vx": vx, "vy": vy, "w": w, "inverse_mass": inverse_mass, "inverse_inertia": inverse_inertia,
    }.items():  # fmt: skip
        motion[name] = value
    handle = Body(world, row, int(body["serial"]))
    handle._turn()
    return handle


def add_revolute(
    world: World,
    body1: Body,
    body2: Body,
    anchor: Pair,
    softness: float,
    bias_factor: float | None,
    collide_connected: bool,
) -> RevoluteJoint:
    """Checks everything, then writes the joint's row: World.create_joint_revolute says what the arguments mean."""
    for name, body in (("body1", body1), ("body2", body2)):
        check_body(world, name, body)
    if body1 == body2:
        raise validate.refuse("body2", body2, "another body than body1")
    if body1.kind == "static" and body2.kind == "static":
        raise validate.refuse("body2", body2, "dynamic where body1 is static")
    x, y = validate.vector("anchor", anchor)
    softness = validate.non_negative("softness", softness)
    validate.in_range(world.precision, softness=(softness,))
    if bias_factor is None:
        bias_factor = JOINT_BIAS_FACTOR
    bias_factor = validate.between("bias_factor", bias_factor, 0.0, 1.0)
    collide_connected = validate.switch("collide_connected", collide_connected)

    values: dict[str, Any] = {
        "body1": body1._row,
        "body2": body2._row,
        "softness": softness,
        "bias_factor": bias_factor,
        "collide_connected": collide_connected,
    }
    for number, body in ((1, body1), (2, body2)):
        c, s = cos_sin(body.angle)
        local = unrotate(Vec2(c, s), Vec2(x, y) - body.position)
        values[f"anchor{number}_x"], values[f"anchor{number}_y"] = local
    storage = world._state.joints
    row = storage.add()
    for name, value in values.items():
        storage.tables["joints"][name][row] = value
    return RevoluteJoint(world, row, int(storage.tables["joints"]["serial"][row]))


def check_body(world: World, name: str, body: Any) -> Body:
    """A living body of this world."""
    if not isinstance(body, Body):
        raise validate.refuse(name, body, "a body of this world")
    if body.world is not world:
        raise validate.refuse(name, body, "a body of this world, not of another")
    if not body.alive:
        raise validate.refuse(name, body, "a living body, this one was destroyed")
    return body
