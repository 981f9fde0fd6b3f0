"""A world for each effect, with every shape where it matters: with and without compilation the bits must be the same.

Run as a program, it prints as JSON: {world: [state hash of each step]}, and the signatures of each effect's kernels.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable

import numba

from engine import Box, Capsule, Circle, Polygon, World
from tests.engine.worlds import DT, POINTS, PRECISIONS, floor

STEPS = 12
SHAPES = (Box(1, 0.6), Circle(0.4), Capsule(0.8, 0.25), Polygon(POINTS), Polygon(POINTS, radius=0.15))


def add_row(world: World, y: float, **properties: float) -> None:
    """One body of each shape, side by side."""
    for k, shape in enumerate(SHAPES):
        world.create_body(shape, position=(2.0 * k, y), angle=0.3 * k, velocity=(0.5, -1), **properties)


def air(world: World) -> None:
    """Drag and wind."""
    world.wind = (4.0, 0.5)
    add_row(world, 5.0, drag=0.3)
    world.create_body(Circle(0.2), position=(0, 9), velocity=(0, 40), drag=50.0)


def pool(world: World) -> None:
    """Buoyancy, half under and wholly under, in two fluids."""
    world.create_fluid((-3, -5), (20, 0.1), density=2.0, linear_drag=0.7, angular_drag=0.4)
    world.create_fluid((3, -1.9), (5, -1), density=0.5)
    add_row(world, 0.1)
    add_row(world, -2.0)


def attracted(world: World) -> None:
    """Magnets and point gravity."""
    world.gravity = (0, 0)
    world.create_body(Box(1, 1), position=(4, 12), kind="static", magnet=-3.0, attraction=30.0)
    add_row(world, 5.0, magnet=0.8, attraction=1.0)


def blasted(world: World) -> None:
    """Explosions over a floor."""
    floor(world)
    add_row(world, 0.5)
    world.explode((3, 0.2), radius=2.0, falloff=3.0, impulse=1.5)


def motored(world: World) -> None:
    """Three joints: a motor too weak for its load, none, and one that turns two bodies on each other."""
    pin = world.create_body(kind="static")
    bar = world.create_body(Box(2, 0.2), position=(1, 0))
    ball = world.create_body(Circle(0.4), position=(2, -0.5))
    wheel = world.create_body(Polygon(POINTS), position=(2.2, -1.2))
    world.create_joint_revolute(pin, bar, anchor=(0, 0), motor_speed=1.0, max_motor_torque=3.0)
    world.create_joint_revolute(bar, ball, anchor=(2, 0), collide_connected=False)
    world.create_joint_revolute(
        ball, wheel, anchor=(2.2, -1), collide_connected=False, motor_speed=-9.0, max_motor_torque=0.7
    )


def shot_at(world: World) -> None:
    """Bullets and others, fast and spinning, between walls that stand and one that moves."""
    if world.solver != "soft_step":
        return motored(world)
    for x in (-2.0, 10.0):
        world.create_body(Box(0.01, 30), position=(x, 5), kind="static", category=2)
    world.create_body(Box(0.1, 30), position=(9, 5), kind="kinematic", velocity=(-3, 0), angular_velocity=0.5)
    for k, y in enumerate((2.0, 5.0, 8.0)):
        for j, shape in enumerate(SHAPES):
            speed = 90.0 * (j - 1.5) * (k + 1)
            world.create_body(
                shape, position=(1.6 * j, y), velocity=(speed, 9.0 * k), angular_velocity=20.0 * k - 10.0 * j,
                restitution=0.5, bullet=j % 2 == 0, group=-(k == 2),
            )  # fmt: skip
    return None


WORLDS: dict[str, Callable[[World], None]] = {
    build.__name__: build for build in (air, pool, attracted, blasted, motored, shot_at)
}
SOLVERS = ("soft_step", "sequential_impulses")


def variants() -> dict[str, World]:
    """Every world in either precision, with either solver."""
    found = {}
    for name, build in WORLDS.items():
        for precision in PRECISIONS:
            for solver in SOLVERS if precision == "double" else SOLVERS[:1]:
                found[f"{name}, {precision}, {solver}"] = world = World(precision=precision, solver=solver)
                build(world)
    return found


def hashes(world: World) -> list[str]:
    """The state's after each step."""
    rows = []
    for _ in range(STEPS):
        world.step(DT)
        rows.append(world.state_hash()[:16])
    return rows


def signatures() -> dict[str, int]:
    """How many each kernel of the effects was compiled for; kernels that Python calls alone."""
    return {
        f"{name}.{attribute}": len(value.signatures)
        for name, module in list(sys.modules.items())
        if name.startswith("engine.effects.")
        for attribute, value in vars(module).items()
        if isinstance(value, numba.core.dispatcher.Dispatcher) and value.py_func.__module__ == name
    }


if __name__ == "__main__":
    worlds = {name: hashes(world) for name, world in variants().items()}
    json.dump({"worlds": worlds, "signatures": signatures(), "compiled": not numba.config.DISABLE_JIT}, sys.stdout)
