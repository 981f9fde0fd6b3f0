"""What the tests of joints share: one of every kind, and the world that they are made in."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

from engine import EFFECTS, Body, Box, Circle, World
from engine.joints import Joint
from tests.engine.worlds import DT, floor

FORCED = frozenset(effect.name for effect in EFFECTS if "joint" in effect.name) - {"breaking joints"}
FORCED |= {"gravity", "friction"}
"""One compiled program for all of these tests, whatever joints and parts of joints a world has."""

GRAVITY = 10.0


def world_of_joints(**settings: Any) -> World:
    """A world in double precision, unless it is said otherwise, with the code of all joints."""
    return all_joints(World(**{"precision": "double", "sleeping": False, **settings}))


def all_joints(world: World) -> World:
    """Has the code of all joints run, which changes no bit (tests/engine/test_forced.py)."""
    world._state.forced = FORCED
    world._state.stale = True
    return world


def ground_of(world: World) -> Body:
    """A static body without a shape, in the origin."""
    return world.create_body(kind="static")


MAKERS: dict[str, Callable[..., Joint]] = {
    "revolute": lambda world, a, b, **more: world.create_joint_revolute(a, b, **{"anchor": middle(a, b), **more}),
    "distance": lambda world, a, b, **more: world.create_joint_distance(
        a, b, **{"anchor1": tuple(a.position), "anchor2": off(b), **more}
    ),
    "prismatic": lambda world, a, b, **more: world.create_joint_prismatic(
        a, b, **{"anchor": middle(a, b), "axis": (1, 0.5), **more}
    ),
    "weld": lambda world, a, b, **more: world.create_joint_weld(a, b, **{"anchor": middle(a, b), **more}),
    "wheel": lambda world, a, b, **more: world.create_joint_wheel(
        a, b, **{"anchor": tuple(b.position), "axis": (0.3, 1), **more}
    ),
    "motor": lambda world, a, b, **more: world.create_joint_motor(
        a, b, **{"max_force": 40.0, "max_torque": 9.0, **more}
    ),
    "mouse": lambda world, a, b, **more: world.create_joint_mouse(
        a, b, **{"target": middle(a, b), "anchor": off(b), **more}
    ),
    "filter": lambda world, a, b, **more: world.create_joint_filter(a, b, **more),
}  # fmt: skip
"""Every kind of joint between two bodies, in places that are nothing special."""

HOLDING = tuple(kind for kind in MAKERS if kind != "filter")


PARTS: dict[str, dict] = {
    "revolute": {"motor_speed": 2.0, "max_motor_torque": 3.0, "lower": -0.4, "upper": 0.5, "hertz": 2.0},
    "distance": {"motor_speed": 0.5, "max_motor_force": 3.0, "lower": 1.0, "upper": 1.6, "hertz": 2.0},
    "prismatic": {"motor_speed": 0.5, "max_motor_force": 3.0, "lower": -0.2, "upper": 0.3, "hertz": 2.0},
    "weld": {"linear_hertz": 3.0, "angular_hertz": 2.0},
    "wheel": {"motor_speed": 3.0, "max_motor_torque": 3.0, "lower": -0.2, "upper": 0.3},
    "motor": {"linear_hertz": 2.0, "angular_hertz": 1.0},
    "mouse": {"max_force": 8.0},
    "filter": {},
}
"""Everything that may act in them."""


def middle(a: Body, b: Body) -> tuple[float, float]:
    """Half way between two bodies [m]."""
    return ((a.position.x + b.position.x) / 2, (a.position.y + b.position.y) / 2)


def off(body: Body) -> tuple[float, float]:
    """A point of a body that is not its middle [m]."""
    return (body.position.x + 0.1, body.position.y + 0.05)


def two_free(world: World) -> tuple[Body, Body]:
    """Two bodies of different mass that drift and spin."""
    a = world.create_body(Box(1, 0.5), position=(0, 0), angle=0.3, velocity=(1, -0.5), angular_velocity=0.7, mass=2)
    b = world.create_body(
        Box(0.5, 0.8), position=(1.2, 0.4), angle=-0.5, velocity=(-0.4, 1), angular_velocity=-1.1, mass=3.5
    )
    return a, b


class Sprung(NamedTuple):
    """A joint whose spring has one freedom: where it is over its rest, how it moves, and what pulls at it."""

    world: World
    joint: Joint
    value: Callable[[], float]  # [m] or [rad]
    move: Callable[[float, float], None]  # puts it there, with that speed
    inertia: float  # [kg] or [kg m^2]
    pull: Callable[[float], None]  # a force [N] or torque [N m] for the next step
    told: Callable[[], float]  # the force or torque that the joint tells, along the same way


AXIS = (0.6, 0.8)


def slider(world: World, body: Body, joint: Joint, value: Callable[[], float], rest: float = 0.0) -> Sprung:
    """A body of 3 kg that moves along AXIS."""
    x, y = AXIS
    place = body.position

    def move(at: float, speed: float) -> None:
        body.position = (place.x + at * x, place.y + at * y)
        body.velocity = (speed * x, speed * y)

    def pull(force: float) -> None:
        body.force = (force * x, force * y)

    return Sprung(world, joint, value, move, 3.0, pull, lambda: joint.force.x * x + joint.force.y * y)


def turner(world: World, body: Body, joint: Joint) -> Sprung:
    """A body that turns about its middle."""

    def move(at: float, speed: float) -> None:
        body.angle, body.angular_velocity = at, speed

    def pull(torque: float) -> None:
        body.torque = torque

    return Sprung(world, joint, lambda: body.angle, move, body.inertia, pull, lambda: joint.torque)


def _along(body: Body, x: float = 0.0, y: float = 0.0) -> Callable[[], float]:
    return lambda: (body.position.x - x) * AXIS[0] + (body.position.y - y) * AXIS[1]


def one_freedom(name: str, world: World, **more: Any) -> Sprung:
    """A joint of that name, of a body that nothing pulls, to the ground; `more` are keywords of its spring."""
    ground, place = ground_of(world), (1.0, 2.0)
    body = world.create_body(Box(0.6, 0.4), position=place, mass=3)
    make: Any = getattr(world, f"create_joint_{name.split()[0]}")
    kind, _, part = name.partition(" ")
    if part:
        more = {f"{part}_{key}" if key in ("hertz", "damping_ratio") else key: value for key, value in more.items()}
    if kind in ("prismatic", "wheel"):
        joint = make(ground, body, anchor=place, axis=AXIS, **more)
        return slider(world, body, joint, lambda: joint.translation)
    if kind == "distance":
        start = (place[0] - 2 * AXIS[0], place[1] - 2 * AXIS[1])
        joint = make(ground, body, anchor1=start, anchor2=place, **more)
        return slider(world, body, joint, lambda: joint.current_length - 2.0)
    arguments = {"motor": {}, "mouse": {"target": place}}.get(kind, {"anchor": place})
    joint = make(ground, body, **arguments, **more)
    if kind == "revolute" or part == "angular":
        return turner(world, body, joint)
    return slider(world, body, joint, _along(body, *place))


SPRUNG = (
    "revolute", "prismatic", "wheel", "distance", "weld linear", "weld angular", "motor linear", "motor angular",
    "mouse",
)  # fmt: skip
"""Whatever has a spring."""


def joint_omega(world: World, dt: float = DT) -> float:
    """Of a joint that is as stiff as joints are [rad/s]: a quarter of the substep rate (engine/softness.py)."""
    return 2 * math.pi * world.substeps / dt / 4


def spinning_disc(world: World, position: tuple[float, float] = (0.0, 0.0), **more: Any) -> Body:
    """A disc of 2 kg."""
    return world.create_body(Circle(0.5), position=position, mass=2, **more)


def fair(world: World, full: bool = True) -> None:
    """One of every kind, hanging from above a floor, a chain of some, and bodies that fall among them."""
    floor(world)
    top = world.create_body(kind="static", position=(0, 3))
    for k, kind in enumerate(MAKERS):
        a = world.create_body(Box(0.4, 0.3), position=(1.3 * k - 4, 2.2), angle=0.1 * k, mass=1 + 0.3 * k)
        b = world.create_body(Box(0.3, 0.5), position=(1.3 * k - 3.5, 2.0), angle=-0.2 * k, fixed_rotation=k == 3)
        world.create_joint_revolute(top, a, anchor=(1.3 * k - 4, 2.6))
        MAKERS[kind](world, a, b, **(PARTS[kind] if full else {}))
    plate = world.create_body(Box(1, 0.2), position=(7.5, 1), kind="kinematic", velocity=(0.1, 0), angular_velocity=0.3)
    rider = world.create_body(Box(0.3, 0.3), position=(7.9, 1.4))
    world.create_joint_prismatic(plate, rider, anchor=(7.9, 1.4), axis=(1, 0), hertz=1.0)
    links = [world.create_body(Box(0.3, 0.1), position=(0.3 * k - 6, 4)) for k in range(5)]
    for k, (a, b) in enumerate(pairwise(links)):
        world.create_joint_revolute(a, b, anchor=(0.3 * k - 5.85, 4), collide_connected=False)
    world.create_joint_weld(top, links[0], anchor=(-6, 4))
