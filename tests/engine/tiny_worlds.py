"""Tiny worlds, all kinds of them, run with and without compilation: the bits must be the same.

Run as a program, it prints as JSON: {world: [{table: digest} of each step]}, the bits of sine and cosine, and how many
signatures each kernel that Python calls was compiled for.
"""

from __future__ import annotations

import hashlib
import json
import math
import sys
from collections.abc import Callable
from itertools import pairwise

import numba
import numpy as np

from engine import Box, Circle, World
from engine.trigonometry import cos_sin
from tests.engine.worlds import DT, PRECISIONS, floor, tables_of

STEPS = 60
ITERATIONS = 4
SWITCHED = (("boxes", "single"), ("joined", "double"))
SWITCHES = ("accumulate_impulses", "warm_starting", "position_correction")


def boxes(world: World) -> None:
    """Two boxes fall on a floor, one on its corner."""
    floor(world)
    world.create_body(Box(1, 1), position=(0, 0.8), angle=0.6, velocity=(1, -2))
    world.create_body(Box(0.7, 0.4), position=(0.1, 1.7), angular_velocity=-4, friction=0.9)


def circles(world: World) -> None:
    """Three circles, two of which begin as one."""
    world.create_body(Circle(0.5), position=(0, 0), kind="static")
    for _ in range(2):
        world.create_body(Circle(0.3), position=(0.1, 0.75), mass=2)


def mixed(world: World) -> None:
    """Circles on boxes, in either order of creation, one of them deep inside."""
    world.create_body(Circle(0.4), position=(0.3, 1.3), velocity=(0, -3))
    floor(world)
    world.create_body(Box(1, 1), position=(0, 0.45), angle=0.1)
    world.create_body(Circle(0.2), position=(0.1, 0.4))


def joined(world: World) -> None:
    """A chain of three on a pin, one joint soft, two of its bodies not colliding."""
    pin = world.create_body(Box(0.2, 0.2), kind="static")
    bodies = [pin]
    for k in range(3):
        bodies.append(world.create_body(Box(0.6, 0.2), position=(0.5 + 0.55 * k, 0), angle=0.1 * k))
    for k, (a, b) in enumerate(pairwise(bodies)):
        world.create_joint_revolute(
            b, a, anchor=(0.25 + 0.55 * k, 0), collide_connected=k != 1, softness=0.02 * (k == 2), bias_factor=0.3
        )


def changing(world: World) -> None:
    """Bodies go and come, so that rows are not in the order of creation."""
    boxes(world)
    world.bodies[1].destroy()
    world.create_body(Circle(0.4), position=(0, 0.6))
    world.create_body(Box(0.5, 0.5), position=(0.2, 1.1), angle=math.pi / 4)
    world.bodies[1].apply_force((3, 2), (0.2, 1.5))


WORLDS: dict[str, Callable[[World], None]] = {
    build.__name__: build for build in (boxes, circles, mixed, joined, changing)
}  # fmt: skip


def variants() -> dict[str, World]:
    """Every world in either precision, and some with each switch off."""
    found = {}
    for name, build in WORLDS.items():
        for precision in PRECISIONS:
            for off in (None, *SWITCHES) if (name, precision) in SWITCHED else (None,):
                world = World(precision=precision, iterations=ITERATIONS)
                if off:
                    setattr(world, off, False)
                build(world)
                found[f"{name}, {precision}" + (f", no {off}" if off else "")] = world
    return found


def digests(world: World) -> list[dict[str, str]]:
    """What a later step depends on, after each step, and what the outside sees."""
    rows = []
    for _ in range(STEPS):
        world.step(DT)
        tables = tables_of(world)
        tables["records"] = world.contact_records().tobytes() + world.joint_records().tobytes()
        tables["diagnostics"] = repr(world.diagnostics()).encode()
        tables["hash"] = world.state_hash().encode()
        rows.append({name: hashlib.sha256(bits).hexdigest()[:12] for name, bits in tables.items()})
    return rows


def trigonometry() -> str:
    """The bits of sine and cosine of some thousand angles."""
    rng = np.random.default_rng(1)
    small, large, any_size = rng.uniform(-10, 10, 2000), rng.uniform(-1e6, 1e6, 1000), rng.uniform(-300, 300, 500)
    angles = np.concatenate([small, large, 10.0**any_size])
    pairs = np.array([cos_sin(angle) for angle in angles])
    return hashlib.sha256(pairs.tobytes()).hexdigest()


def signatures() -> dict[str, int]:
    """Signatures of each kernel of the engine that was called from Python."""
    counts = {}
    for name, module in list(sys.modules.items()):
        if name.startswith("engine."):
            for attribute, value in vars(module).items():
                if isinstance(value, numba.core.dispatcher.Dispatcher) and value.py_func.__module__ == name:
                    counts[f"{name}.{attribute}"] = len(value.signatures)
    return counts


def report() -> dict:
    return {
        "worlds": {name: digests(world) for name, world in variants().items()},
        "trigonometry": trigonometry(),
        "signatures": signatures(),
        "compiled": not numba.config.DISABLE_JIT,
    }


if __name__ == "__main__":
    json.dump(report(), sys.stdout)
