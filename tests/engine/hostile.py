"""Values and calls that a world should not break at: what `test_hostile` draws from."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from hypothesis import strategies as st

from engine import EFFECTS, SOLVERS, Body, Box, Capsule, Chain, Circle, Joint, Polygon, Segment, World
from engine.settings import describe

RUBBISH = (
    math.nan, math.inf, -math.inf, 1e39, -1e39, 1.7e308, 1e-320, -0.0, 0, -1, 2**63, 10**400, None, True, "1", "", b"1",
    (), [], {}, 1j, object(), np.float32("nan"), np.array([1.0, 2.0]), np.array(math.nan), Box, (math.nan, 0.0),
    (0.0, math.inf), (1.0,), (1.0, 2.0, 3.0), ("a", "b"), (1e39, -1e39), (1e300, 1e300), [None, None],
)  # fmt: skip
NUMBERS = st.one_of(st.floats(-4.0, 4.0, width=32), st.floats(0.125, 2.0, width=32))
PAIRS = st.tuples(NUMBERS, NUMBERS)
PROPERTIES = (
    "friction", "restitution", "rolling_resistance", "tangent_speed", "linear_damping", "gravity_scale", "drag",
    "magnet", "attraction", "bullet", "can_sleep", "category", "mask", "group", "density",
)  # fmt: skip
BODY_ATTRIBUTES = ("position", "angle", "velocity", "angular_velocity", "friction", "force", "torque", "fixed_rotation",
                   *PROPERTIES)  # fmt: skip
JOINTS: dict[str, tuple[str, ...]] = {
    "revolute": ("anchor", "softness", "bias_factor", "lower", "upper", "hertz", "motor_speed", "max_motor_torque"),
    "distance": ("anchor1", "anchor2", "length", "lower", "upper", "hertz", "motor_speed", "max_motor_force"),
    "prismatic": ("anchor", "axis", "lower", "upper", "hertz", "target", "motor_speed", "max_motor_force"),
    "weld": ("anchor", "linear_hertz", "angular_hertz", "break_force", "break_torque"),
    "wheel": ("anchor", "axis", "lower", "upper", "hertz", "damping_ratio", "motor_speed", "max_motor_torque"),
    "motor": ("offset", "angle", "max_force", "max_torque", "linear_hertz"),
    "mouse": ("target", "anchor", "hertz", "damping_ratio", "max_force"),
    "filter": (),
}
VECTORS = {
    "position",
    "velocity",
    "force",
    "anchor",
    "anchor1",
    "anchor2",
    "axis",
    "offset",
    "target",
    "gravity",
    "wind",
}
SETTINGS = tuple(info.name for info in describe() if info.name != "precision")

Draw = Callable[[st.SearchStrategy], Any]


class Place:
    """A world, and what its handles are: alive, destroyed, or of another world."""

    def __init__(self, draw: Draw) -> None:
        self.draw = draw
        self.world = World()
        self.world._state.forced = frozenset(effect.name for effect in EFFECTS)  # one compiled variant for all draws
        self.world.create_body(Box(20, 1), position=(0, -0.5), kind="static")
        gone = self.world.create_body(Box(1, 1))
        gone.destroy()
        other = World().create_body(Circle(1))
        self.strangers: list[Any] = [gone, other, None, "body", 7]
        self.ends: list[Any] = []  # joints that were destroyed

    def value(self, name: str) -> Any:
        """Of an argument of that name: mostly one that makes sense, now and then rubbish."""
        if self.draw(st.integers(0, 2)) == 0:
            return self.draw(st.sampled_from(RUBBISH))
        return self.draw(PAIRS if name in VECTORS else NUMBERS)

    def body(self) -> Any:
        """A living body, or now and then none of this world's."""
        if self.draw(st.integers(0, 5)) == 0:
            return self.draw(st.sampled_from(self.strangers))
        return self.draw(st.sampled_from(self.world.bodies))

    def some(self, names: tuple[str, ...], most: int = 3) -> dict[str, Any]:
        """Arguments by some of the names."""
        chosen = self.draw(st.lists(st.sampled_from(names), max_size=most, unique=True)) if names else []
        return {name: self.value(name) for name in chosen}


# --- calls ------------------------------------------------------------------------------------------------------------


def shape(place: Place) -> Any:
    """One that can be, or not."""
    value = place.value
    points = [(value("x"), value("y")) for _ in range(place.draw(st.integers(2, 5)))]
    makers: tuple[Callable[[], Any], ...] = (
        lambda: Box(value("width"), value("height")),
        lambda: Circle(value("radius")),
        lambda: Capsule(value("length"), value("radius")),
        lambda: Polygon(tuple(points), value("radius")),
        lambda: Segment(points[0], points[1]),
        lambda: Chain(tuple(points), closed=place.draw(st.sampled_from([True, False, None]))),
        lambda: place.draw(st.sampled_from(RUBBISH)),
    )
    return place.draw(st.sampled_from(makers))()


def create(place: Place) -> None:
    """A body."""
    kind = place.draw(st.sampled_from(["dynamic", "dynamic", "kinematic", "static", "solid", None]))
    arguments = place.some(("position", "velocity", "angle", "angular_velocity", "offset", "mass", *PROPERTIES))
    place.world.create_body(shape(place), kind=kind, **arguments)


def create_many(place: Place) -> None:
    """Several at once."""
    positions = [place.value("position") for _ in range(place.draw(st.integers(0, 3)))]
    place.world.create_bodies(shape(place), positions=positions, **place.some(("angles", "velocities", "mass")))


def add_shape(place: Place) -> None:
    """To a body."""
    body = place.body()
    if isinstance(body, Body):
        body.add_shape(shape(place), **place.some(("offset", "angle", "mass", *PROPERTIES)))


def join(place: Place) -> None:
    """Two bodies by any kind of joint."""
    kind = place.draw(st.sampled_from(sorted(JOINTS)))
    needed = {name: place.value(name) for name in JOINTS[kind] if name in ("anchor", "anchor1", "anchor2", "axis")}
    needed |= {"target": place.value("target")} if kind == "mouse" else {}
    arguments = {**needed, **place.some(JOINTS[kind])}
    getattr(place.world, f"create_joint_{kind}")(place.body(), place.body(), **arguments)


def change_body(place: Place) -> None:
    """An attribute of a body, destroyed or not."""
    body = place.body()
    if isinstance(body, Body):
        name = place.draw(st.sampled_from(BODY_ATTRIBUTES))
        if hasattr(type(body), name):
            setattr(body, name, place.value(name))


def change_joint(place: Place) -> None:
    """A number of a joint, destroyed or not."""
    joints: list[Joint] = [*place.world.joints, *place.ends]
    if joints:
        joint = place.draw(st.sampled_from(joints))
        names = [name for name in JOINTS[joint.kind] if hasattr(type(joint), name)]
        if names:
            name = place.draw(st.sampled_from(names))
            if getattr(type(joint), name).__class__ is not property or getattr(type(joint), name).fset is not None:
                setattr(joint, name, place.value(name))


def push(place: Place) -> None:
    """Forces and impulses."""
    body = place.body()
    if isinstance(body, Body):
        way = place.draw(st.sampled_from([body.apply_force, body.apply_impulse]))
        way(place.value("force"), place.draw(st.sampled_from([None, (0.0, 0.0), (math.nan, 0.0)])))


def destroy(place: Place) -> None:
    """A body or a joint, perhaps for the second time."""
    joints = place.world.joints
    if joints and place.draw(st.booleans()):
        joint = place.draw(st.sampled_from(joints))
        joint.destroy()
        place.ends.append(joint)
    else:
        body = place.body()
        if isinstance(body, Body) and place.world.body_count > 2:
            body.destroy()
            place.strangers.append(body)


def set_up(place: Place) -> None:
    """A setting; the solver's stay as they are, for another one is compiled for long."""
    name = place.draw(st.sampled_from(SETTINGS))
    value = place.draw(st.sampled_from(RUBBISH)) if name in ("solver", "broad_phase") else place.value(name)
    if not (isinstance(value, str) and value in SOLVERS):
        place.world.set(**{name: value})


def ask(place: Place) -> None:
    """Queries."""
    world = place.world
    query = place.draw(
        st.sampled_from([
            lambda value: world.body_at(value),
            lambda value: world.bodies[0].contains(value),
            lambda value: world.bodies[-1].velocity_at(value),
            lambda value: world.restore(value),
            lambda value: world.explode(value, radius=place.value("radius"), impulse=place.value("impulse")),
            lambda value: world.create_fluid(value, place.value("position"), density=place.value("density")),
        ])
    )  # fmt: skip
    query(place.value("position"))


def step(place: Place) -> None:
    """A step or a few, of any length that is refused, or of one that is not."""
    place.world.step(place.draw(st.sampled_from([1 / 60, 1 / 60, 1 / 30, 0.0, -1.0, *RUBBISH])))


def run(place: Place) -> None:
    """Several steps at once."""
    place.world.run(place.draw(st.sampled_from([1, 3, 0, -1, 1.5, None, "3"])), 1 / 60)


CALLS = (create, create, create_many, add_shape, join, join, change_body, change_body, change_body, change_body,
         change_joint, change_joint, push, destroy, set_up, set_up, ask, step, step, run)  # fmt: skip
