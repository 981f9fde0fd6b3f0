"""Ten thousand discs in a net of joints: nothing but joints to solve."""

from __future__ import annotations

import numpy as np

from engine import Body, Circle, World
from sandbox.scenes.benchmark.parts import grid_places
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.registry import scene

SIDE = 100  # discs a side, 1 m apart
HELD = range(SIDE // 2 - 3, SIDE // 2 + 4)  # of the uppermost row
CATEGORY = 2
OTHERS = 2**63 - 1 - CATEGORY  # every category but its own


def widest_gap(world: World) -> float:
    """How far the two anchors of a joint are apart, at most [m]."""
    joints = world.joint_records()
    return float(np.hypot(joints["x2"] - joints["x1"], joints["y2"] - joints["y1"]).max())


@scene(
    "Benchmark/Joint Grid",
    shows=Criterion(
        "the two halves of a joint are apart by",
        widest_gap,
        unit="m",
        after=0.5,
        at_most=0.5,  # half a mesh
    ),
    view=(49.5, -55.0, 135.0),
)
def joint_grid(world: World) -> None:
    """A net of 10,000 discs hangs by 19,794 joints from seven of its uppermost discs, and sags.

    As Box2D's joint_grid: discs of 0.4 m radius that never collide, joined half way to the next, right and down. There
    the seven, which are static, are joined with each other as well: six joints that do nothing.
    """
    places = grid_places(SIDE, SIDE, 0.0, 0.0, 1.0, -1.0)
    held = np.array([SIDE * k for k in HELD])
    free = np.setdiff1d(np.arange(SIDE * SIDE), held)
    net: dict[int, Body] = {}
    for kind, numbers in (("static", held), ("dynamic", free)):
        discs = world.create_bodies(
            Circle(0.4), positions=places[numbers], kind=kind, friction=0.6, category=CATEGORY, mask=OTHERS
        )
        net.update(zip(numbers.tolist(), discs, strict=True))
    for k in range(SIDE):
        for i in range(SIDE):
            disc = net[SIDE * k + i]
            if i > 0:
                join(world, net[SIDE * k + i - 1], disc, (k, 0.5 - i))
            if k > 0:
                join(world, net[SIDE * (k - 1) + i], disc, (k - 0.5, -i))


def join(world: World, body1: Body, body2: Body, anchor: tuple[float, float]) -> None:
    """Unless both are held already."""
    if "dynamic" in (body1.kind, body2.kind):
        world.create_joint_revolute(body1, body2, anchor=anchor)
