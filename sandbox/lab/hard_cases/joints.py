"""Chains, bridges, nets and machines."""

from __future__ import annotations

import itertools
import math

import numpy as np

from engine import Box, Circle, World
from sandbox.lab.hard_cases.case import Case, case, variant
from sandbox.scenes import find_scene
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.bridges import THICK, add_deck
from sandbox.scenes.joints.chains import BALL, LENGTH
from sandbox.scenes.joints.parts import gap, gaps, hanging
from sandbox.scenes.parts import GRAVITY, ROUGH
from sandbox.scenes.robustness import chains

# --- ball and chain, bridges ------------------------------------------------------------------------------------------

SWINGS = 8.0  # [s]


def energy_of_swing(world: World) -> float:
    """Energy over that of the beginning, in parts of what the ball can fall [J/J]."""
    fall = float(world.body_records()["mass"][-1]) * GRAVITY * (LENGTH + BALL)
    return world.diagnostics().energy / fall


BALL_AND_CHAIN = (
    gaps(SWINGS, at_most=0.01 * LENGTH),
    Criterion("the energy has grown, in parts of the fall, to", energy_of_swing, "", SWINGS, 0.01, throughout=True),
    Criterion(
        "the fastest of the ball, in parts of what it gains in its fall, is",
        lambda world: math.hypot(*world.velocities[-1]) / math.sqrt(2.0 * GRAVITY * (LENGTH + BALL)),
        unit="",
        after=SWINGS,
        at_least=0.95,  # the chain, a sixth of its mass, takes some of it or gives some
        throughout=True,
    ),
)

BRIDGE_160 = (gaps(6.0, at_most=0.1 * THICK), *find_scene("Joints/Bridge").shows[1:])  # and nothing falls through

PLANKS, SPAN, SAG, CROSSED = 500, 250.0, 25.0, 10.0  # [m], [s]
DECK = hanging((-0.5 * SPAN, 0.0), (0.5 * SPAN, 0.0), SAG, PLANKS)


def bridge_500(world: World) -> None:
    """Planks along a parabola, near what they hang as."""
    banks = world.create_body(kind="static")
    banks.add_shape(Box(10.0, 2.0), offset=(-0.5 * SPAN - 5.5, -1.0), friction=ROUGH)
    add_deck(world, banks, DECK, THICK, 20.0)


def catenary(points: list[tuple[float, float]]) -> float:
    """How deep the middle of rigid planks hangs that are as long as those between the points [m].

    Each hangs along the mean of the pulls at its ends: horizontally H everywhere, vertically what hangs below.
    H is what spans the span.
    """
    lengths = np.array([math.dist(a, b) for a, b in itertools.pairwise(points)])
    below = np.cumsum(lengths) - 0.5 * lengths - 0.5 * lengths.sum()  # weight from the middle to each plank's middle
    span = points[-1][0] - points[0][0]
    low, high = 1e-6, 1e6
    for _ in range(200):
        pull = math.sqrt(low * high)
        reach = float((lengths * pull / np.hypot(pull, below)).sum())
        low, high = (pull, high) if reach < span else (low, pull)
    half = len(lengths) // 2
    return float(-(lengths * below / np.hypot(pull, below))[:half].sum())


HANGS = catenary(DECK)


def middle(world: World) -> float:
    """Height of the middle between the banks [m]."""
    return float(world.positions[PLANKS // 2 : PLANKS // 2 + 2, 1].mean())


BRIDGE_500 = (
    gaps(CROSSED, at_most=0.1 * THICK),
    Criterion(
        "the middle hangs, in parts of its catenary, at",
        lambda world: -middle(world) / HANGS,
        unit="",
        after=CROSSED,
        at_least=0.98,
        at_most=1.02,
    ),
    Criterion(
        "the middle has been off where it began by",
        lambda world: abs(SAG + middle(world)),
        unit="m",
        after=CROSSED,
        at_least=abs(SAG - HANGS),  # it begins so far from its rest, and swings about it
        throughout=True,
    ),
)

# --- net --------------------------------------------------------------------------------------------------------------

SIDE, MESH = 20, 1.0  # knots a side; from one to the next [m]
SWUNG = 8.0  # [s]


def net(world: World) -> None:
    """Discs in a net that hangs by three of its uppermost knots."""
    held = {0, SIDE // 2, SIDE - 1}
    rows = []
    for k in range(SIDE):
        rows.append([
            world.create_body(
                Circle(0.4), position=(MESH * i, -MESH * k), mask=0,
                kind="static" if k == 0 and i in held else "dynamic",
            )
            for i in range(SIDE)
        ])  # fmt: skip
    for k, i in itertools.product(range(SIDE), range(SIDE)):
        for down, right in ((0, 1), (1, 0)):
            if k + down < SIDE and i + right < SIDE:
                anchor = (MESH * (i + 0.5 * right), -MESH * (k + 0.5 * down))
                world.create_joint_revolute(rows[k][i], rows[k + down][i + right], anchor=anchor)


NET = (
    gaps(SWUNG, at_most=0.5 * MESH),
    Criterion("in the end, a joint's anchors are apart by", gap, "m", SWUNG, at_most=0.05 * MESH),
)


CASES: dict[str, Case] = {
    **{
        f"chain_end_{ratio}": variant(
            "Robustness/Heavy Chain End",
            chains.hanging(float(ratio)),
            f"Twenty links carry a weight of {ratio} links.",
            shows=chains.hangs(float(ratio)),
            quick=True,
        )
        for ratio in (10, 100, 1000)
    },
    "ball_and_chain": case("Joints/Ball and Chain", shows=BALL_AND_CHAIN, quick=True),
    "wrecking_ball": case("Joints/Wrecking Ball"),
    "stretched_chain": case("Robustness/Stretched Chain", quick=True),
    "bridge_160": case("Joints/Bridge", shows=BRIDGE_160),
    "bridge_500": variant("Joints/Bridge", bridge_500, "A bridge of 500 planks, 250 m long.", shows=BRIDGE_500),
    "joint_grid": variant("Benchmark/Joint Grid", net, "A net of 400 discs hangs by three of them.", shows=NET),
    "cantilever": case("Joints/Cantilever"),
    "soft_donuts": case("Joints/Soft Donuts"),
    "scissor_lift": case("Joints/Scissor Lift"),
    "telescope": case("Robustness/Telescope", quick=True),
    "door": case("Joints/Door"),
    "cart": case("Robustness/Cart", quick=True),
    "windmill": case("Joints/Windmill"),
    "ragdolls": case("Joints/Ragdolls"),
}
