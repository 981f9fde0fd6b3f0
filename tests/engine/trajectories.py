"""Running a reference trajectory of Box2D Lite again: see tests/data/box2d_lite/README.md for the format."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from engine import Box, World
from tests.engine.worlds import talk

DATA = Path(__file__).parent.parent / "data" / "box2d_lite"
NAMES = sorted(path.stem for path in DATA.glob("*.json"))


@dataclass
class Reference:
    start: dict
    trajectory: np.ndarray  # (steps + 1, bodies, 6): x, y, angle, vx, vy, w
    contacts: np.ndarray  # (k, 14): step, body1, body2, four edges, position, normal, separation, P_n, P_t
    joints: np.ndarray  # (steps, joints, 2): accumulated impulse


def load(name: str) -> Reference:
    start = json.loads((DATA / f"{name}.json").read_text())
    with np.load(DATA / f"{name}.npz") as data:
        return Reference(start, data["trajectory"], data["contacts"], data["joints"])


def build(start: dict, precision: str = "double", broad_phase: str = "dynamic_tree") -> World:
    """The world that a reference starts from."""
    world = talk(
        gravity=start["gravity"], iterations=start["iterations"], precision=precision, broad_phase=broad_phase
    )  # fmt: skip
    for name in ("accumulate_impulses", "warm_starting", "position_correction"):
        setattr(world, name, bool(start.get(name, True)))
    bodies = []
    for body in start["bodies"]:
        kind = {"kind": "static"} if body["mass"] < 0 else {"mass": body["mass"]}
        bodies.append(
            world.create_body(
                Box(*body["width"]),
                position=body["position"],
                angle=body["rotation"],
                friction=body["friction"],
                velocity=body.get("velocity", (0, 0)),
                angular_velocity=body.get("angular_velocity", 0.0),
                **kind,
            )
        )
    for joint in start["joints"]:
        world.create_joint_revolute(
            bodies[joint["body1"]],
            bodies[joint["body2"]],
            anchor=joint["anchor"],
            softness=joint["softness"],
            bias_factor=joint["biasFactor"],
        )
    return world


def row(world: World) -> np.ndarray:
    """(bodies, 6): the world's state as the references have it."""
    return np.column_stack([world.positions, world.angles, world.velocities, world.angular_velocities])
