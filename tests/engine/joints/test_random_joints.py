"""Random scenes of mixed joints and shapes: finite, the same each time, no energy from nowhere, joints that hold.

TUMBLE_RANDOM_SCENES=500 runs so many, half of them with motors; 60 if it is not set.
"""

from __future__ import annotations

import math
import os

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from engine import Box, Capsule, Circle, Polygon, World
from engine.tables import ALONG_NOTHING, ALONG_WAY, JOINT_KINDS, SPRING
from tests.engine.joints.making import GRAVITY, all_joints
from tests.engine.worlds import DT, POINTS, floor

SCENES = int(os.environ.get("TUMBLE_RANDOM_SCENES", "60"))
STEPS, PIECE = 600, 60
FARTHEST, FAR = 0.5, 0.3
"""That joints are off [m], when bodies of a hundred times their bodies' mass hit something, and at the end."""

KINDS = [kind for kind in JOINT_KINDS if kind != "filter"]

random_scenes = settings(
    max_examples=max(SCENES // 2, 1), deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow],
    phases=[Phase.explicit, Phase.generate],  # a smaller seed is no smaller scene
)  # fmt: skip


def scene(seed: int, motors: bool) -> World:
    """5 to 12 bodies that do not overlap, above a floor, joined at random as they are; some joints close loops."""
    rng = np.random.default_rng(seed)
    world = all_joints(World(precision="double", gravity=(0, -GRAVITY)))
    ground = floor(world)
    shapes = (
        lambda: Box(*rng.uniform(0.2, 0.7, 2)), lambda: Circle(rng.uniform(0.1, 0.45)),
        lambda: Capsule(rng.uniform(0.1, 0.4), rng.uniform(0.1, 0.2)), lambda: Polygon(POINTS),
    )  # fmt: skip
    bodies = []
    for k in range(int(rng.integers(5, 13))):
        place = (1.1 * (k % 4) - 1.65, 0.8 + 1.1 * (k // 4))
        fixed = bool(rng.random() < 0.1)
        bodies.append(
            world.create_body(
                shapes[int(rng.integers(4))](), position=place, angle=rng.uniform(-3, 3),
                density=10 ** rng.uniform(0, 1), friction=rng.uniform(0, 1), velocity=tuple(rng.normal(0, 1.5, 2)),
                angular_velocity=0.0 if fixed else rng.normal(0, 2), fixed_rotation=fixed,
            )
        )  # fmt: skip
    for k in range(1, len(bodies)):
        if rng.random() < 0.85:
            add_joint(world, rng, bodies[int(rng.integers(max(0, k - 4), k))], bodies[k], motors)
    for _ in range(int(rng.integers(0, 3))):
        one, other = rng.choice(len(bodies), 2, replace=False)
        add_joint(world, rng, bodies[one], bodies[other], motors)
    if rng.random() < 0.5:
        add_joint(world, rng, ground, bodies[int(rng.integers(len(bodies)))], motors)
    return world


def add_joint(world: World, rng: np.random.Generator, a, b, motors: bool) -> None:
    """One of any kind but filters, of bodies that are as they are to be, with any of its parts."""
    kind = KINDS[int(rng.integers(len(KINDS)))]
    middle = tuple((np.array(a.position) + np.array(b.position)) / 2 if a.kind == "dynamic" else b.position)
    point, collide = tuple(np.array(middle) + rng.uniform(-0.3, 0.3, 2)), bool(rng.random() < 0.5)
    more: dict = {"collide_connected": collide}
    spring = {"hertz": rng.uniform(0.5, 5), "damping_ratio": rng.uniform(0, 1.5)}
    if kind in ("revolute", "prismatic", "wheel", "distance"):
        rest = 0.0
        if kind == "distance":
            ends = tuple(np.array(a.position) + 0.1), tuple(np.array(b.position) - 0.1)
            if a.kind != "dynamic":
                ends = (b.position.x, b.position.y + 1.0), ends[1]
            rest = math.dist(*ends)
            more |= {"anchor1": ends[0], "anchor2": ends[1]}
        else:
            more |= {"anchor": point}
        if kind in ("prismatic", "wheel"):
            more |= {"axis": tuple(rng.normal(0, 1, 2))}
        if rng.random() < 0.4:
            more |= {"lower": rest - min(rest, 0.5) * rng.random(), "upper": rest + 0.5 * rng.random()}
            if kind != "distance":
                more["lower"] = -0.5 * rng.random()
        if rng.random() < 0.4:
            more |= spring
        if motors and rng.random() < 0.5:
            strength = "max_motor_torque" if kind in ("revolute", "wheel") else "max_motor_force"
            more |= {"motor_speed": rng.uniform(-3, 3), strength: rng.uniform(0, 10)}
    elif kind == "weld":
        more |= {"anchor": point}
        if rng.random() < 0.4:
            more |= {f"{part}_{name}": value for part in ("linear", "angular") for name, value in spring.items()}
    elif kind == "motor":
        more |= {"max_force": rng.uniform(0, 60), "max_torque": rng.uniform(0, 10)}
        more |= {f"{part}_{name}": value for part in ("linear", "angular") for name, value in spring.items()}
    else:
        more |= {"target": point, "anchor": None, "max_force": rng.uniform(5, 200), **spring}
    getattr(world, f"create_joint_{kind}")(a, b, **more)


def motor_power(world: World) -> float:
    """What motors can do at most [W]: their strength at their speed; faster they brake, slower they do less."""
    tables, order = world._state.joints.tables, world._state.joints.order
    parts = [tables[name][order] for name in ("turns", "slides")]
    return float(
        sum((part["max_motor"] * np.abs(part["motor_speed"]) * (part["motored"] != 0)).sum() for part in parts)
    )


def stored(world: World) -> float:
    """An upper bound of the energy that springs hold [J]: k x^2 / 2, k = m w^2 with the mass of what they move."""
    tables, order = world._state.joints.tables, world._state.joints.order
    records, motions = world.joint_records(), world._state.bodies.tables["motions"]
    total = 0.0
    for row, record in zip(order, records, strict=True):
        joint, turn, slide = (tables[name][row] for name in ("joints", "turns", "slides"))
        one, two = motions[joint["body1"]], motions[joint["body2"]]
        way = np.array([record["x2"] - record["x1"], record["y2"] - record["y1"]])
        mass, inertia = (
            1 / max(one[name] + two[name], 1e-12) for name in ("inverse_mass", "inverse_inertia")
        )  # fmt: skip
        omega = 2 * math.pi
        if joint["hertz"] > 0:
            total += 0.5 * mass * (omega * joint["hertz"]) ** 2 * float(way @ way)
        if turn["along"] != ALONG_NOTHING and turn["spring"] == SPRING and inertia < 1e9:
            bodies = world._state.bodies.tables["bodies"]
            angle = bodies["angle"][joint["body2"]] - bodies["angle"][joint["body1"]] - joint["reference_angle"]
            total += 0.5 * inertia * (omega * turn["hertz"]) ** 2 * float(angle - turn["target"]) ** 2
        if slide["along"] != ALONG_NOTHING and slide["spring"] == SPRING:
            c, s = one["cosine"], one["sine"]
            axis = np.array([c * joint["axis_x"] - s * joint["axis_y"], s * joint["axis_x"] + c * joint["axis_y"]])
            value = float(np.hypot(*way)) if slide["along"] == ALONG_WAY else float(axis @ way)
            total += 0.5 * mass * (omega * slide["hertz"]) ** 2 * (value - float(slide["target"])) ** 2
    return total


def off_by(world: World) -> float:
    """How far anchors that are held rigidly are from where they are to be [m]."""
    worst = 0.0
    for joint, record in zip(world.joints, world.joint_records(), strict=True):
        x, y = record["x2"] - record["x1"], record["y2"] - record["y1"]
        if joint.kind == "revolute" or (joint.kind == "weld" and joint.linear_hertz is None):
            worst = max(worst, math.hypot(x, y))
        elif joint.kind in ("prismatic", "wheel"):
            axis = joint.axis
            worst = max(worst, abs(axis.x * y - axis.y * x))
        elif joint.kind == "distance" and joint.hertz is None and joint.motor_speed is None:
            length = math.hypot(x, y)
            lower = joint.length if joint.lower is None and joint.upper is None else joint.lower or 0.0
            upper = joint.length if joint.lower is None and joint.upper is None else joint.upper or math.inf
            worst = max(worst, lower - length, length - upper)
    return worst


@pytest.mark.parametrize("motors", [False, True])
def test_random_scenes(motors: bool) -> None:
    @random_scenes
    @given(seed=st.integers(0, 2**31))
    def holds(seed: int) -> None:
        world, again = scene(seed, motors), scene(seed, motors)
        energy, power = world.diagnostics().energy + stored(world), motor_power(world)
        assert power == 0.0 or motors
        for piece in range(1, STEPS // PIECE + 1):
            world.run(PIECE, DT)
            now = world.diagnostics().energy
            assert math.isfinite(now)
            assert np.isfinite(world.positions).all()
            assert now <= energy + power * piece * PIECE * DT + 1e-3 * (1 + abs(energy)), (piece, now - energy)
            assert off_by(world) < FARTHEST, piece
            if piece == 2:
                again.run(2 * PIECE, DT)
                assert again.state_hash() == world.state_hash()
        assert off_by(world) < FAR, "at the end"

    holds()
