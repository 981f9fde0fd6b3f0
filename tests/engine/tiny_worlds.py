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
from typing import Any

import numba
import numpy as np

from engine import SOLVERS, Box, Capsule, Chain, Circle, Polygon, Segment, World
from engine.settings import describe
from engine.trigonometry import cos_sin
from tests.engine.joints.making import MAKERS, PARTS
from tests.engine.worlds import DT, POINTS, PRECISIONS, floor, tables_of

STEPS = 20
ITERATIONS = 4  # of the talk's solver
SWITCHED = (("boxes", "single"), ("joined", "double"))
SWITCHES = ("accumulate_impulses", "warm_starting", "position_correction")
MATTERS = {info.name: info.solvers for info in describe()}  # to which solvers; none: to all


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


def outlines(world: World) -> None:
    """Every shape on every shape that it can touch, chains and segments below."""
    ground = world.create_body(kind="static")
    ground.add_shape(Chain(((-4, 0.6), (-2, 0.05), (0, 0), (1.5, 0.1))))
    ground.add_shape(Segment((1.4, 0.1), (5, 0.3)), friction=0.7)
    world.create_body(Capsule(0.8, 0.2), position=(-2.5, 0.6), angle=0.3, angular_velocity=2)
    world.create_body(Polygon(POINTS), position=(-1.4, 0.5), angle=2.0)
    world.create_body(Circle(0.25), position=(-0.5, 0.3), velocity=(-1, 0))
    world.create_body(Box(0.6, 0.4), position=(0.2, 0.3), angle=0.2)
    world.create_body(Polygon(POINTS, radius=0.1), position=(-2.2, 1.2), velocity=(0.5, -2))
    world.create_body(Circle(0.2), position=(-1.3, 1.3), velocity=(0, -2))
    world.create_body(Capsule(0.4, 0.15), position=(-0.2, 0.8), angle=1.2, velocity=(0, -1))
    world.create_body(Box(0.5, 0.5), position=(2, 0.5), angle=0.5, velocity=(-1, -1))
    world.create_body(Polygon(POINTS), position=(2.9, 0.75), velocity=(-1, 0))
    world.create_body(Capsule(0.4, 0.15), position=(3.6, 0.6), angle=1.0)
    world.create_body(Circle(0.3), position=(2.1, 1.2), velocity=(1, -2))


def compounds(world: World) -> None:
    """Bodies of several shapes with their centres off their origins, one of which loses and gains a shape."""
    floor(world)
    hammer = world.create_body(Box(0.2, 1.0), position=(0, 0.8), angle=0.4, friction=0.9)
    hammer.add_shape(Capsule(0.5, 0.15), offset=(0.1, 0.5), angle=0.3, density=4)
    other = world.create_body(Polygon(POINTS), position=(0.9, 0.7), velocity=(-1, 0))
    head = other.add_shape(Circle(0.3), offset=(0.2, 0.4))
    world.create_joint_revolute(hammer, other, anchor=(0.5, 0.9))
    head.destroy()
    other.add_shape(Box(0.3, 0.3), offset=(-0.4, 0.2), angle=0.7, density=0.5)


def driven(world: World) -> None:
    """Kinematic bodies, bodies that do not turn, and all that slows or lightens a body by itself."""
    plate = world.create_body(Box(3, 0.3), position=(0, 0.2), kind="kinematic", velocity=(0.7, 0.2))
    plate.angular_velocity = 0.4
    world.create_body(Box(0.5, 0.5), position=(-0.6, 0.65), fixed_rotation=True, angle=0.1)
    world.create_body(Circle(0.3), position=(0.3, 0.8), linear_damping=1.5, angular_damping=0.5, angular_velocity=9)
    world.create_body(Capsule(0.3, 0.2), position=(0.9, 0.9), gravity_scale=0.25, velocity=(0, -2))
    world.create_body(Box(0.3, 0.3), position=(0, 1.6), gravity_scale=-0.5, angular_damping=3, angular_velocity=7)


def filtered(world: World) -> None:
    """Categories, masks and groups: some pass through each other."""
    floor(world, category=2)
    world.create_body(Box(0.5, 0.5), position=(0, 0.3), category=4, mask=2)
    world.create_body(Box(0.5, 0.5), position=(0.1, 0.7), category=4, mask=4)
    world.create_body(Circle(0.3), position=(0.2, 0.5), group=-3)
    world.create_body(Circle(0.3), position=(0.3, 0.6), group=-3)
    world.create_body(Circle(0.2), position=(0.5, 0.4), group=7, mask=0)
    world.create_body(Circle(0.2), position=(0.6, 0.5), group=7, mask=0)


def lively(world: World) -> None:
    """What sequential_impulses lacks: restitution, rolling resistance, belts; on every shape."""
    floor(world, tangent_speed=0.8, restitution=0.1)
    world.create_body(Circle(0.3), position=(-1, 0.5), velocity=(0, -3), restitution=0.8)
    world.create_body(Box(0.5, 0.3), position=(0, 0.2), angle=0.1, velocity=(0, -2), restitution=0.5)
    world.create_body(Circle(0.25), position=(1, 0.26), velocity=(3, 0), rolling_resistance=0.3)
    world.create_body(Capsule(0.4, 0.2), position=(2, 0.3), angle=0.2, rolling_resistance=0.1, tangent_speed=-0.5)
    world.create_body(Polygon(POINTS, radius=0.1), position=(3, 0.5), restitution=0.4, rolling_resistance=0.2)
    world.create_body(Circle(0.3), position=(1.1, 0.9), velocity=(0, -4), restitution=1.0, rolling_resistance=0.5)


def frictionless(world: World) -> None:
    """No friction and no gravity."""
    world.gravity = (0, 0)
    world.create_body(Box(1, 1), position=(0, 0), velocity=(1, 0), friction=0)
    world.create_body(Box(0.7, 0.4), position=(0.95, 0.2), angle=0.4, velocity=(-1, 0), friction=0)
    world.create_body(Circle(0.3), position=(0.2, 0.9), velocity=(0, -2), friction=0)


def sleepers(world: World) -> None:
    """Three stacks that soon sleep, one of them joined; a ball hits the first, a plate goes to the second."""
    world.sleep_time = 0.1
    floor(world)
    for x in (0, 4, 8):
        one, other = (world.create_body(Box(1, 1), position=(x, 0.5 + k), friction=0.6) for k in range(2))
    world.create_joint_revolute(one, other, anchor=(8, 1))
    world.create_body(Circle(0.4), position=(-2.6, 1.2), velocity=(8, 0), friction=0.4)
    world.create_body(Box(1, 0.3), position=(6.3, 1.5), kind="kinematic", velocity=(-6, 0))


def jointed(world: World) -> None:
    """Joints of every kind with all their parts, two of them under a mass that calls for them to be solved at once."""
    for k, kind in enumerate(MAKERS):
        a = world.create_body(Box(0.4, 0.3), position=(1.3 * k - 4, 2.2), angle=0.1 * k, velocity=(0, -1))
        b = world.create_body(Box(0.3, 0.5), position=(1.3 * k - 3.5, 2.0), angle=-0.2 * k, fixed_rotation=k == 3)
        MAKERS[kind](world, a, b, **PARTS[kind])
    top = world.create_body(kind="static", position=(0, 5))
    a = world.create_body(Box(0.1, 0.6), position=(0, 4.7))
    b = world.create_body(Box(0.8, 0.8), position=(0, 4.0), mass=300)
    world.create_joint_weld(top, a, anchor=(0, 5))
    world.create_joint_prismatic(a, b, anchor=(0, 4.4), axis=(1, 0.2), lower=-0.1, upper=0.1, collide_connected=False)


def parts(world: World) -> None:
    """Joints that are rows, with all that may act in them, and what bounces: for solvers that lack some kinds."""
    for k, kind in enumerate(("revolute", "distance", "prismatic", "weld", "wheel")):
        a = world.create_body(Box(0.4, 0.3), position=(1.5 * k - 4, 2.2), angle=0.1 * k, velocity=(0, -1))
        b = world.create_body(Box(0.3, 0.5), position=(1.5 * k - 3.5, 2.0), angle=-0.2 * k, fixed_rotation=k == 3)
        MAKERS[kind](world, a, b, **PARTS[kind] if k else {"softness": 0.1, "lower": -0.05})
    floor(world, restitution=0.1)
    world.create_body(Circle(0.3), position=(5, 0.5), velocity=(0, -3), restitution=0.8)
    world.create_body(Box(0.5, 0.3), position=(6, 0.2), angle=0.1, velocity=(0, -2), restitution=0.5)


WORLDS: dict[str, Callable[[World], None]] = {
    build.__name__: build
    for build in (
        boxes, circles, mixed, joined, changing, outlines, compounds, driven, filtered, lively, frictionless,
        sleepers, jointed, parts,
    )
}  # fmt: skip
NOT_FOR_ALL = {
    "lively": ("soft_step", "xpbd"),
    "jointed": ("soft_step",),
    "parts": ("ngs", "xpbd", "direct"),
}
"""Worlds that call for what some solvers lack, with those that are tried."""

ONLY = {"direct": ("boxes", "joined", "frictionless", "parts")}
"""Without compilation its dense systems take long."""

SETTINGS: dict[str, dict[str, Any]] = {  # of some of them, with soft_step
    "boxes": {"substeps": 3, "iterations": 2},
    "circles": {"stiffness": "fixed", "substeps": 8},
    "mixed": {"recycling": False, "tell_events": True, "hit_speed": 0.5},
    "lively": {
        "restitution_mixing": "mean",
        "friction_mixing": "least",
        "restitution_threshold": 0.2,
        "tell_events": True,
    },
}


def fill(name: str, solver: str, precision: str, **settings: Any) -> World:
    """A world of that name."""
    talk = {"iterations": ITERATIONS} if solver == "sequential_impulses" else {}
    world = World(solver=solver, precision=precision, **{**talk, **settings})
    WORLDS[name](world)
    return world


def cases() -> dict[str, tuple[str, str, str, dict[str, Any]]]:
    """Arguments of `fill`: every world with either solver and in either precision, and some with other settings."""
    found = {}
    for name in WORLDS:
        for solver in SOLVERS:
            if name not in ONLY.get(solver, tuple(WORLDS)) or (name in NOT_FOR_ALL and solver not in NOT_FOR_ALL[name]):
                continue
            for precision in PRECISIONS:
                changes: list[dict[str, Any]] = [{}]
                if (name, precision) in SWITCHED:
                    changes += [
                        {switch: False} for switch in SWITCHES if not MATTERS[switch] or solver in MATTERS[switch]
                    ]
                if solver == "soft_step" and precision == "single" and name in SETTINGS:
                    changes.append(SETTINGS[name])
                for change in changes:
                    more = "".join(f", {setting} {value}" for setting, value in change.items())
                    found[f"{name}, {solver}, {precision}{more}"] = (name, solver, precision, change)
    return found


def digests(world: World) -> list[dict[str, str]]:
    """What a later step depends on, after each step, and what the outside sees."""
    rows = []
    for _ in range(STEPS):
        world.step(DT)
        tables = tables_of(world)
        tables["records"] = world.contact_records().tobytes() + world.joint_records().tobytes()
        tables["diagnostics"] = repr(world.diagnostics()).encode()
        if world.tell_events:
            tables["events"] = b"".join(rows.tobytes() for rows in world.events)
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
        "worlds": {title: digests(fill(*case[:3], **case[3])) for title, case in cases().items()},
        "trigonometry": trigonometry(),
        "signatures": signatures(),
        "compiled": not numba.config.DISABLE_JIT,
    }


if __name__ == "__main__":
    json.dump(report(), sys.stdout)
