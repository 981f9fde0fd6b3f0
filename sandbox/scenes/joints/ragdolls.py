"""Ragdolls that fall down a stair."""

from __future__ import annotations

from engine import Box, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.human import BONES, GRIP, POSES, add_human, bent_too_far
from sandbox.scenes.joints.parts import gaps
from sandbox.scenes.registry import scene

STEPS, RISE, TREAD = 10, 0.5, 0.7  # [m]
TOP = STEPS * RISE


@scene(
    "Joints/Ragdolls",
    shows=(
        gaps(5.0, at_most=2.0 * min(bone.radius for bone in BONES.values())),  # a bone's thickness, where one lands
        Criterion(
            "a joint is bent beyond its limits by",
            lambda w: bent_too_far(w, 1),
            "rad",
            5.0,
            at_most=0.2,
            throughout=True,
        ),
        Criterion(
            "the middles of all bones are, on average, at a height of",
            lambda w: float(w.positions[1:, 1].mean()),
            "m",
            5.0,
            at_most=0.5 * TOP,  # they have fallen, from above the stair's top to below its middle
        ),
    ),
    view=(0.0, 4.2, 11.5),
)
def ragdolls(world: World) -> None:
    """Six ragdolls fall down a stair: elbows and knees bend one way only."""
    ground = world.create_body(kind="static")
    ground.add_shape(Box(30.0, 1.0), offset=(4.0, -0.5), friction=GRIP)
    for k in range(STEPS):
        height = TOP - RISE * k
        ground.add_shape(Box(TREAD, height), offset=(-4.0 + TREAD * (k + 0.5), 0.5 * height), friction=0.5 * GRIP)
    ground.add_shape(Box(4.0, TOP), offset=(-6.0, 0.5 * TOP), friction=0.5 * GRIP)
    for k in range(6):
        place = (-6.2 + 0.9 * k, TOP + 1.3 + (2.2 if k % 2 else 0.2 * k))
        add_human(world, place, group=k + 1, pose=POSES[k % 3], angle=-0.5 - 0.2 * k, velocity=(4.0, 0.0))
