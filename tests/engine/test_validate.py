"""Bad input is a ValueError that names the argument, its value and what is allowed, and it changes nothing.

Every entrance of the engine is in ENTRANCES: what a call needs, and what its argument is called.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import (
    Body,
    Box,
    Capsule,
    Chain,
    Circle,
    Polygon,
    RevoluteJoint,
    Segment,
    Settings,
    ShapeHandle,
    World,
    validate,
)
from engine.properties import Attribute
from engine.settings import describe
from tests.engine.worlds import POINTS, PRECISIONS, busy, fingerprint, regular, run

NO_NUMBERS = [math.nan, math.inf, -math.inf, np.float32("nan"), "1", b"1", "", True, False, np.True_, [1.0], (1.0,), {},
              1j, object(), np.array([1.0]), np.array(1.0), 10**400, -(10**5000), np.longdouble("1e4000")]  # fmt: skip
NONE = [None]
NO_POSITIVE = [*NO_NUMBERS, 0, 0.0, -0.0, -1, -1e-300]
NEGATIVE = [*NO_NUMBERS, -1, -1e-300]
NO_VECTORS = [None, 5, 1.5, True, "12", b"12", (), (1,), (1, 2, 3), (math.nan, 0), (0, math.inf), (True, 0), ("1", 2),
              (None, 0), ([1], [2]), np.zeros((2, 2)), np.array(1.0), np.zeros(3), object(), {}]  # fmt: skip
NO_VECTORS.append((10**400, 0))
NO_SWITCHES = [None, 0, 1, 1.0, "True", "", [True]]
NO_WHOLE = [True, 0, -1, 1.5, 10.0, "10", math.nan, math.inf, 10_001, 10**5000, [5], np.array([5])]
NO_NAMES = [None, "", "Dynamic", 1, True, b"dynamic", ["dynamic"], "verlet"]
NO_SHAPES = ["box", 1.0, Box, (1, 1), object()]
NO_BITS = [*(value for value in NO_WHOLE if value not in (0, 10_001)), 2**63]
NO_POINTS = [None, 5, "123", b"123", object(), [], [(0, 0)], [(0, 0), (1, 0), (math.nan, 1)], [(0, 0), (1, 0), (1,)],
             [(0, 0), (1, 0), None], [(0, 0), (1, 0), (True, 1)], np.zeros(3), np.zeros((3, 3)), [(0, 0), (1, 0), "ab"],
             [(0, 0), (1, 0), (0, 10**400)]]  # fmt: skip
NO_POLYGONS = [
    *NO_POINTS,
    [(0, 0), (1, 0)],  # two corners
    [(math.cos(k), math.sin(k)) for k in np.linspace(0, 6, 9)],  # nine
    [(0, 0), (2, 0), (0.2, 0.2), (0, 2)],  # concave
    [(0, 0), (1, 0), (2, 0)],  # in a line
    [(0, 0), (1, 0), (2, 0), (1, 1)],  # a corner that is none
    [(0, 0), (1, 0), (1, 0), (0, 1)],  # the same corner twice
    [(0, 0), (1, 1), (1, 0), (0, 1)],  # a bow tie
    [(math.cos(k * 4 * math.pi / 5), math.sin(k * 4 * math.pi / 5)) for k in range(5)],  # a pentagram: round twice
    [(0, 0), (1, 0), (0, 1), (0, 0)],  # closed by hand
    [(0, 0), (0, 0), (0, 0)],
    [(0, 0), (1, 1e-12), (2, 0)],  # all but in a line
    [(1, 1), (1, 1), (-1, 1)],  # turns clockwise, whichever way one goes
    [(0.5, 1), (-1, -1), (0.5, -1), (0.5, 2)],
]
NO_CHAINS = [*NO_POINTS, [(0, 0), (1, 0), (1, 0)], [(1, 1)] * 2]
NO_ROWS = [None, 5, "12", b"12", object(), np.array(1.0), [(0, 0), (1,)], [(0, 0), None], [(0, 0, 0)],
           np.zeros((2, 3)), [("a", "b")], np.zeros(2), [("1", "2")], [(True, False)], [(0, 10**400)], [0, 1],
           np.zeros((2, 2, 2)), [[(0, 0)]], [(0, 1j)]]  # fmt: skip


class Scene:
    """A world at work, and the handles that a call needs."""

    def __init__(self, precision: str) -> None:
        self.precision = precision
        self.world = run(busy(precision), 30)
        self.ground, self.box, *_, self.bob = self.world.bodies
        self.joint = self.world.joints[0]
        self.shape = self.box.shapes[0]
        self.box.apply_force((1, 2))
        self.foreign = World(precision=precision).create_body(Box(1, 1))
        self.gone = self.world.create_body(Box(1, 1))
        self.gone.destroy()

    def create(self, **arguments: Any) -> Body:
        return self.world.create_body(arguments.pop("shape", Box(1, 1)), **arguments)

    def add_shape(self, **arguments: Any) -> ShapeHandle:
        return self.box.add_shape(arguments.pop("shape", Box(1, 1)), **arguments)

    def create_two(self, **arguments: Any) -> list[Body]:
        return self.world.create_bodies(
            arguments.pop("shape", Box(1, 1)), **{"positions": [(9, 9), (9, 12)], **arguments}
        )  # fmt: skip

    def join(self, **arguments: Any) -> RevoluteJoint:
        return self.world.create_joint_revolute(
            arguments.pop("body1", self.box), arguments.pop("body2", self.bob), **{"anchor": (0, 0), **arguments}
        )


Call = Callable[[Scene, Any], Any]


def setter(owner: str, name: str) -> Call:
    return lambda scene, value: setattr(getattr(scene, owner), name, value)


def creator(name: str, **others: Any) -> Call:
    return lambda scene, value: scene.create(**{name: value}, **others)


def adder(name: str, **others: Any) -> Call:
    return lambda scene, value: scene.add_shape(**{name: value}, **others)


def several(name: str, **others: Any) -> Call:
    return lambda scene, value: scene.create_two(**{name: value}, **others)


def joiner(name: str) -> Call:
    return lambda scene, value: scene.join(**{name: value})


def maker(name: str) -> Call:
    return lambda scene, value: World(**{name: value})


def entrances_of_settings() -> dict[str, tuple[str, Call, list]]:
    """Every setting, when a world is made and while it lives."""
    found: dict[str, tuple[str, Call, list]] = {}
    for info in describe():
        numbers = NO_POSITIVE if info.low > 0 else NEGATIVE
        bad = {"vector": NO_VECTORS, "choice": [*NO_NAMES, "half"], "switch": NO_SWITCHES, "whole": NO_WHOLE,
               "number": numbers + NONE}[info.kind]  # fmt: skip
        found[f"World.{info.name}"] = (info.name, maker(info.name), bad)
        found[f"world.{info.name}"] = (info.name, setter("world", info.name), bad)
    return found


BODY_NUMBERS = {"linear_damping": NEGATIVE, "angular_damping": NEGATIVE, "gravity_scale": NO_NUMBERS}
SHAPE_NUMBERS = {
    "restitution": [*NEGATIVE, 1.0001], "rolling_resistance": NEGATIVE, "tangent_speed": NO_NUMBERS,
    "category": NO_BITS, "mask": NO_BITS, "group": [*NO_BITS[1:], -(2**31) - 1],
}  # fmt: skip
SHAPE_NUMBERS["group"] = [value for value in SHAPE_NUMBERS["group"] if not isinstance(value, int) or value != -1]


def entrances_of_properties() -> dict[str, tuple[str, Call, list]]:
    """What effects bring: when a body or a shape is made, and while it lives."""
    found: dict[str, tuple[str, Call, list]] = {}
    for name, bad in (BODY_NUMBERS | SHAPE_NUMBERS).items():
        found[f"create.{name}"] = (name, creator(name), bad + NONE)
        found[f"create_bodies.{name}"] = (name, several(name), bad + NONE)
    for name, bad in BODY_NUMBERS.items():
        found[f"body.{name}"] = (name, setter("box", name), bad + NONE)
    for name, bad in SHAPE_NUMBERS.items():
        found[f"add_shape.{name}"] = (name, adder(name), bad + NONE)
        found[f"shape.{name}"] = (name, setter("shape", name), bad + NONE)
    return found


# id: (argument's name in the message, how to hand it in, bad values)
ENTRANCES: dict[str, tuple[str, Call, list]] = {
    "Box.width": ("width", lambda scene, value: Box(value, 1), NO_POSITIVE + NONE),
    "Box.height": ("height", lambda scene, value: Box(1, value), NO_POSITIVE + NONE),
    "Circle.radius": ("radius", lambda scene, value: Circle(value), NO_POSITIVE + NONE),
    "Capsule.length": ("length", lambda scene, value: Capsule(value, 1), NO_POSITIVE + NONE),
    "Capsule.radius": ("radius", lambda scene, value: Capsule(1, value), NO_POSITIVE + NONE),
    "Polygon.points": ("points", lambda scene, value: Polygon(value), NO_POLYGONS),
    "Polygon.clockwise_points": ("points", lambda scene, value: Polygon(value[::-1]), NO_POLYGONS[len(NO_POINTS) :]),
    "Polygon.radius": ("radius", lambda scene, value: Polygon(POINTS, value), NEGATIVE + NONE),
    "Segment.a": ("a", lambda scene, value: Segment(value, (1, 1)), NO_VECTORS),
    "Segment.b": ("b", lambda scene, value: Segment((1, 1), value), [*NO_VECTORS, (1, 1), (1.0, 1)]),
    "Chain.points": ("points", lambda scene, value: Chain(value), NO_CHAINS),
    "Chain.closed_points": (
        "points",
        lambda scene, value: Chain(value, closed=True),
        [*NO_CHAINS, [(0, 0), (1, 1)], [(0, 0), (1, 0), (0, 1), (0, 0)]],
    ),
    "Chain.closed": ("closed", lambda scene, value: Chain(POINTS, value), NO_SWITCHES),
    "step.dt": ("dt", lambda scene, value: scene.world.step(value), NEGATIVE + NONE),
    "create.fixed_rotation": ("fixed_rotation", creator("fixed_rotation"), NO_SWITCHES),
    "create.offset": ("offset", creator("offset"), NO_VECTORS),
    "create.shape_angle": ("shape_angle", creator("shape_angle"), NO_NUMBERS + NONE),
    "create.massive_segment": ("mass", creator("mass", shape=Segment((0, 0), (1, 0))), [1.0, 5]),
    "create.mass_of_no_shape": ("shape", creator("shape", mass=1.0), NONE),
    "create.density_of_no_shape": ("shape", creator("shape", density=1.0), NONE),
    "create.restitution_of_no_shape": ("shape", creator("shape", restitution=0.5), NONE),
    "create.property": ("property", lambda scene, value: scene.create(**{value: 1}), ["color", "Restitution"]),
    "create_bodies.shape": ("shape", several("shape"), [*NO_SHAPES, None]),
    "create_bodies.positions": ("positions", several("positions"), NO_ROWS),
    "create_bodies.no_position": (
        "positions[1]",
        several("positions"),
        [[(0, 0), (0, math.nan)], [(0, 0), (math.inf, 1)]],
    ),
    "create_bodies.no_angle": ("angles[0]", several("angles"), [math.nan, [math.inf, 0]]),
    "create_bodies.no_velocity": ("velocities[1]", several("velocities"), [[(0, 0), (0, math.nan)]]),
    "create_bodies.angles": ("angles", several("angles"), [None, "a", "1", True, [1, 2, 3], [[1], [2]], {}, object()]),
    "create_bodies.velocities": ("velocities", several("velocities"), [None, 1j, [(1, 2)] * 3, [(1, 2, 3)] * 2]),
    "create_bodies.angular_velocities": ("angular_velocities", several("angular_velocities"), [None, [1, 2, 3]]),
    "create_bodies.mass": ("mass", several("mass"), NO_POSITIVE),
    "create_bodies.density": ("density", several("density"), NO_POSITIVE),
    "create_bodies.friction": ("friction", several("friction"), NEGATIVE + NONE),
    "create_bodies.kind": ("kind", several("kind"), NO_NAMES),
    "create_bodies.static_velocity": ("velocity", several("velocities", kind="static"), [(1, 0), [(0, 0), (0, -1)]]),
    "create_bodies.fixed_rotation": ("fixed_rotation", several("fixed_rotation"), NO_SWITCHES),
    "create_bodies.property": ("property", lambda scene, value: scene.create_two(**{value: 1}), ["color", "mask "]),
    "add_shape.shape": ("shape", adder("shape"), [*NO_SHAPES, None]),
    "add_shape.mass": ("mass", adder("mass"), NO_POSITIVE),
    "add_shape.density": ("density", adder("density"), NO_POSITIVE),
    "add_shape.mass_and_density": ("density", adder("density", mass=1), [1.0, 2]),
    "add_shape.friction": ("friction", adder("friction"), NEGATIVE + NONE),
    "add_shape.offset": ("offset", adder("offset"), NO_VECTORS),
    "add_shape.angle": ("angle", adder("angle"), NO_NUMBERS + NONE),
    "add_shape.property_of_a_body": (
        "property",
        lambda scene, value: scene.add_shape(**{value: 1}),
        ["linear_damping"],
    ),
    "body.fixed_rotation": ("fixed_rotation", setter("box", "fixed_rotation"), NO_SWITCHES),
    "shape.friction": ("friction", setter("shape", "friction"), NEGATIVE + NONE),
    "create.shape": ("shape", creator("shape"), NO_SHAPES),
    "create.position": ("position", creator("position"), NO_VECTORS),
    "create.angle": ("angle", creator("angle"), NO_NUMBERS + NONE),
    "create.kind": ("kind", creator("kind"), NO_NAMES),
    "create.mass": ("mass", creator("mass"), NO_POSITIVE),
    "create.density": ("density", creator("density"), NO_POSITIVE),
    "create.static_mass": ("mass", creator("mass", kind="static"), NO_POSITIVE),
    "create.mass_and_density": ("density", creator("density", mass=1), [1.0, 2]),
    "create.friction": ("friction", creator("friction"), NEGATIVE + NONE),
    "create.velocity": ("velocity", creator("velocity"), NO_VECTORS),
    "create.static_velocity": ("velocity", creator("velocity", kind="static"), [*NO_VECTORS, (1, 0), (0, -1e-9)]),
    "create.angular_velocity": ("angular_velocity", creator("angular_velocity"), NO_NUMBERS + NONE),
    "body.position": ("position", setter("box", "position"), NO_VECTORS),
    "body.angle": ("angle", setter("box", "angle"), NO_NUMBERS + NONE),
    "body.rotation": ("angle", setter("box", "rotation"), NO_NUMBERS + NONE),
    "body.velocity": ("velocity", setter("box", "velocity"), NO_VECTORS),
    "body.static_velocity": ("velocity", setter("ground", "velocity"), [*NO_VECTORS, (1, 0)]),
    "body.angular_velocity": ("angular_velocity", setter("box", "angular_velocity"), NO_NUMBERS + NONE),
    "body.static_angular_velocity": ("angular_velocity", setter("ground", "angular_velocity"), [*NO_NUMBERS, 1.0]),
    "body.friction": ("friction", setter("box", "friction"), NEGATIVE + NONE),
    "body.force": ("force", setter("box", "force"), NO_VECTORS),
    "body.torque": ("torque", setter("box", "torque"), NO_NUMBERS + NONE),
    "body.apply_force": ("force", lambda scene, value: scene.box.apply_force(value), NO_VECTORS),
    "body.apply_force.point": ("point", lambda scene, value: scene.box.apply_force((1, 1), value), NO_VECTORS[1:]),
    "body.apply_impulse": ("impulse", lambda scene, value: scene.box.apply_impulse(value), NO_VECTORS),
    "body.apply_impulse.point": ("point", lambda scene, value: scene.box.apply_impulse((1, 1), value), NO_VECTORS[1:]),
    "body.contains": ("point", lambda scene, value: scene.box.contains(value), NO_VECTORS),
    "body.velocity_at": ("point", lambda scene, value: scene.box.velocity_at(value), NO_VECTORS),
    "world.body_at": ("point", lambda scene, value: scene.world.body_at(value), NO_VECTORS),
    "world.body_at.kind": ("kind", lambda scene, value: scene.world.body_at((0, 0), value), NO_NAMES),
    "joint.anchor": ("anchor", joiner("anchor"), NO_VECTORS),
    "joint.softness": ("softness", joiner("softness"), NEGATIVE + NONE),
    "joint.bias_factor": ("bias_factor", joiner("bias_factor"), [*NEGATIVE, 1.0001]),
    "joint.collide_connected": ("collide_connected", joiner("collide_connected"), NO_SWITCHES),
    "joint.body1": ("body1", joiner("body1"), [None, 0, "box", Box(1, 1)]),
    "joint.body2": ("body2", joiner("body2"), [None, 0, "box", Box(1, 1)]),
    "joint.set_softness": ("softness", setter("joint", "softness"), NEGATIVE + NONE),
    "joint.set_bias_factor": ("bias_factor", setter("joint", "bias_factor"), [*NEGATIVE, 1.0001]),
    "world.restore": ("snapshot", lambda scene, value: scene.world.restore(value), [None, b"", {}, 1]),
    **entrances_of_settings(),
    **entrances_of_properties(),
}

# What no float32 can hold, at every entrance that leads to the solver's own numbers. Doubles take it.
TOO_LARGE_IN_SINGLE: dict[str, tuple[str, Call, Any]] = {
    "create.velocity": ("velocity", creator("velocity"), (0, 1e39)),
    "create.angular_velocity": ("angular_velocity", creator("angular_velocity"), -1e39),
    "create.friction": ("friction", creator("friction"), 1e39),
    "create.mass": ("mass", creator("mass"), 1e39),
    "create.tiny_mass": ("mass", creator("mass"), 1e-39),
    "create.density": ("mass", creator("density"), 1e39),
    "create.inertia": ("inertia", creator("shape", mass=1), Box(1e20, 1)),
    "create.tiny_inertia": ("inertia", creator("shape", mass=1), Circle(1e-20)),
    "create.static_shape": ("shape", creator("shape", kind="static"), Box(1, 1e39)),
    "create.static_polygon": ("shape", creator("shape", kind="static"), Polygon(((0, 0), (1e39, 0), (0, 1e39)))),
    "create.chain": ("shape", creator("shape", kind="static"), Chain(((0, 0), (1e39, 0)))),
    "create.segment": ("shape", creator("shape", kind="static"), Segment((0, 0), (0, 1e39))),
    "create.capsule": ("shape", creator("shape", kind="static"), Capsule(1e39, 1)),
    "create.offset": ("offset", creator("offset"), (0, 1e39)),
    "create.linear_damping": ("linear_damping", creator("linear_damping"), 1e39),
    "create.gravity_scale": ("gravity_scale", creator("gravity_scale"), -1e39),
    "create.tangent_speed": ("tangent_speed", creator("tangent_speed"), 1e39),
    "create_bodies.velocities": ("velocity", several("velocities"), [(0, 0), (0, 1e39)]),
    "create_bodies.angular_velocities": ("angular_velocity", several("angular_velocities"), [1e39, 0]),
    "create_bodies.mass": ("mass", several("mass"), 1e39),
    "add_shape.mass": ("mass", adder("mass"), 1e39),
    "add_shape.offset": ("offset", adder("offset"), (1e39, 0)),
    "shape.friction": ("friction", setter("shape", "friction"), 1e39),
    "shape.rolling_resistance": ("rolling_resistance", setter("shape", "rolling_resistance"), 1e39),
    "body.velocity": ("velocity", setter("box", "velocity"), (1e39, 0)),
    "body.angular_velocity": ("angular_velocity", setter("box", "angular_velocity"), 1e39),
    "body.friction": ("friction", setter("box", "friction"), 1e39),
    "body.force": ("force", setter("box", "force"), (0, -1e39)),
    "body.torque": ("torque", setter("box", "torque"), 1e39),
    "body.apply_force": ("force", lambda scene, value: scene.box.apply_force(value), (1e39, 0)),
    "body.apply_impulse": ("impulse", lambda scene, value: scene.box.apply_impulse(value), (1e39, 0)),
    "joint.softness": ("softness", joiner("softness"), 1e39),
    "joint.set_softness": ("softness", setter("joint", "softness"), 1e39),
    "world.gravity": ("gravity", setter("world", "gravity"), (1e39, 0)),
    "world.contact_hertz": ("contact_hertz", setter("world", "contact_hertz"), 1e39),
    "world.wind": ("wind", setter("world", "wind"), (0, 1e39)),
    "step.dt": ("dt", lambda scene, value: scene.world.step(value), 1e39),
    "step.tiny_dt": ("dt", lambda scene, value: scene.world.step(value), 1e-38),
}

CASES = [(entrance, index) for entrance, (_, _, values) in ENTRANCES.items() for index in range(len(values))]


@pytest.fixture(scope="module", params=PRECISIONS)
def scene(request: pytest.FixtureRequest) -> Scene:
    return Scene(request.param)


def assert_refused(scene: Scene, name: str, call: Call, value: Any) -> None:
    before, handles = fingerprint(scene.world), len(scene.world.bodies)
    with pytest.raises(ValueError, match=rf"(?s)^{re.escape(name)} = .+: must be .+") as caught:
        call(scene, value)
    assert fingerprint(scene.world) == before, "a refusal changed the world"
    assert len(scene.world.bodies) == handles
    assert len(str(caught.value)) < (700 if name == "setting" else 500)  # which names all that may be set


@pytest.mark.parametrize("entrance", ENTRANCES)
def test_refused_by_name_and_nothing_changes(scene: Scene, entrance: str) -> None:
    name, call, values = ENTRANCES[entrance]
    for value in values:
        assert_refused(scene, name, call, value)


@pytest.mark.parametrize("entrance", TOO_LARGE_IN_SINGLE)
def test_too_large_for_single_precision(entrance: str) -> None:
    name, call, value = TOO_LARGE_IN_SINGLE[entrance]
    assert_refused(Scene("single"), name, call, value)
    call(Scene("double"), value)


def test_the_message_shows_the_value() -> None:
    for call, shown in (
        (lambda: Box(-1.5, 1), "width = -1.5: must be a finite number > 0"),
        (lambda: World(solver="magic"), "solver = 'magic': must be one of 'soft_step', 'sequential_impulses'"),
        (lambda: World(substeps=1001), "substeps = 1001: must be a whole number from 1 to 1000"),
        (lambda: Chain([(0, 0), (1, 0), (1, 0)]), "of different neighbours, (1.0, 0.0) comes twice in a row"),
        (lambda: Polygon(((0, 0), (1, 0), (2, 0))), "must be the corners of a convex polygon, one after another"),
        (lambda: Polygon(regular(9)), "must be 3 to 8 points (x, y) of finite numbers"),
        (lambda: World().create_body(Circle(1), restitution=2), "restitution = 2: must be a number from 0 to 1"),
        (lambda: World().create_body(Segment((0, 0), (1, 0)), mass=1), "mass = 1.0: must be left out for a segment"),
        (lambda: World().create_body(Box(1, 1), bounce=1), "property = 'bounce': must be one of "),
        (lambda: World(iterations=0), "iterations = 0: must be a whole number from 1 to 10000"),
        (lambda: World().step(-0.1), "dt = -0.1: must be a finite number >= 0"),
        (lambda: World(gravity=(0, math.nan)), "gravity = (0, nan): must be two finite numbers (x, y)"),
        (lambda: World(warm_starting=1), "warm_starting = 1: must be True or False"),
    ):
        with pytest.raises(ValueError, match=re.escape(shown)):
            call()


def test_a_long_value_is_cut_short() -> None:
    with pytest.raises(ValueError, match=r"^angle = '7{79}\.\.\.: must be"):
        World().create_body(Box(1, 1), angle="7" * 1000)  # type: ignore[arg-type]


@pytest.mark.parametrize("which", ["foreign", "gone"])
def test_bodies_of_other_worlds_and_destroyed_ones(scene: Scene, which: str) -> None:
    for name in ("body1", "body2"):
        assert_refused(scene, name, joiner(name), getattr(scene, which))


def test_joint_of_a_body_with_itself_or_of_two_static_ones(scene: Scene) -> None:
    assert_refused(scene, "body2", joiner("body2"), scene.box)
    wall = scene.world.create_body(Box(1, 1), position=(50, 50), kind="static")
    assert_refused(scene, "body2", lambda scene, value: scene.join(body1=scene.ground, body2=value), wall)
    wall.destroy()


def test_destroyed_body_refuses_everything(scene: Scene) -> None:
    before = fingerprint(scene.world)
    names = [
        name
        for name, member in vars(Body).items()
        if isinstance(member, (property, Attribute)) and name != "alive" and not name.startswith("_")
    ]
    assert {"position", "mass", "force", "shape", "shapes", "direction", "center", "linear_damping"} <= set(names)
    for name in names:
        with pytest.raises(ValueError, match=r"^body = Body \d+: must be a living body"):
            getattr(scene.gone, name)
    settable = {"position": (0, 0), "angle": 0.0, "velocity": (0, 0), "angular_velocity": 0.0, "force": (0, 0),
                "torque": 0.0, "friction": 0.1, "linear_damping": 1.0, "fixed_rotation": True}  # fmt: skip
    for name, value in settable.items():
        with pytest.raises(ValueError, match="must be a living body"):
            setattr(scene.gone, name, value)
    for call in (
        scene.gone.destroy,
        lambda: scene.gone.apply_force((1, 1)),
        lambda: scene.gone.apply_impulse((1, 1)),
        lambda: scene.gone.contains((0, 0)),
        lambda: scene.gone.add_shape(Box(1, 1)),
        lambda: scene.gone.velocity_at((0, 0)),
    ):
        with pytest.raises(ValueError, match="must be a living body"):
            call()
    assert fingerprint(scene.world) == before


def test_precision_is_fixed(scene: Scene) -> None:
    other = "double" if scene.precision == "single" else "single"
    assert_refused(scene, "precision", lambda scene, value: scene.world.set(precision=value), other)
    assert_refused(
        scene, "snapshot.precision", lambda scene, value: scene.world.restore(value), Scene(other).world.snapshot()
    )


def test_several_settings_are_taken_all_or_none(scene: Scene) -> None:
    assert_refused(scene, "gravity", lambda scene, value: scene.world.set(iterations=77, gravity=value), (1, math.nan))
    assert_refused(scene, "setting", lambda scene, value: scene.world.set(iterations=77, **{value: 1}), "itrations")
    assert scene.world.iterations == 1


@settings(max_examples=200, deadline=None)
@given(value=st.one_of(st.none(), st.text(), st.booleans(), st.floats(), st.integers(), st.lists(st.floats())))
def test_a_number_comes_back_or_is_refused(value: Any) -> None:
    good = isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300
    if good:
        assert validate.number("x", value) == float(value)
        assert type(validate.number("x", value)) is float
    elif not isinstance(value, (int, float)) or isinstance(value, bool) or not math.isfinite(value):
        with pytest.raises(ValueError, match=r"^x = "):
            validate.number("x", value)


@pytest.mark.parametrize("real", [np.float32, np.float64, np.int64, np.uint8, np.float16])
def test_numpy_numbers_are_numbers(real: type) -> None:
    assert validate.number("x", real(3)) == 3.0
    assert validate.vector("x", np.array([1, 2], real)) == (1.0, 2.0)
    assert World(iterations=np.int32(5)).iterations == 5  # type: ignore[arg-type]


def test_smallest_time_steps() -> None:
    for precision, smallest in (("single", 1.2e-38), ("double", 2.3e-308)):
        for chosen in ({"solver": "sequential_impulses"}, {"substeps": 1}, {"substeps": 4}, {"substeps": 50}):
            world = run(busy(precision, **chosen), 3)
            with pytest.raises(ValueError, match=rf"^dt = .*: must be 0 or a normal {precision} precision number"):
                world.step(0.9 * smallest * world.substeps)
            world.step(smallest * world.substeps)
            assert np.isfinite(world.positions).all()
            assert np.isfinite(world.velocities).all()


def test_settings_refuse_by_themselves() -> None:
    with pytest.raises(ValueError, match=r"^iterations = 0"):
        Settings(iterations=0)
