"""Chains that hang: with a weight at the end, and put together with gaps."""

from __future__ import annotations

import math

import numpy as np

from engine import Body, Capsule, Circle, World
from sandbox.lab.sag import is_soft, joint_hertz
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.chains import add_chain
from sandbox.scenes.joints.parts import gap
from sandbox.scenes.parts import GRAVITY, Predict, and_a_fifth, moved
from sandbox.scenes.registry import Build, scene

LINKS, LENGTH, WIDTH = 20, 10.0, 0.1  # [m]
END = 0.6  # radius of what hangs on it [m]
OPEN = 0.02  # how far its joint stands open in the beginning [m]
BEGIN = np.array([(0.0, -LENGTH * (k + 0.5) / LINKS) for k in range(LINKS)] + [(0.0, -LENGTH - END - OPEN)])
"""Where the links and the end begin [m]."""
CALM = 0.05  # [m/s]


def fastest(world: World) -> float:
    """Of all bodies [m/s]."""
    return float(np.hypot(*world.velocities.T).max())


def weakest_hertz(world: World, dt: float) -> float:
    """Frequency of joints [Hz]; of a solver without springs that of soft_step with its four substeps."""
    return joint_hertz(world, dt) if is_soft(world) else 1.0 / dt


def hung(ratio: float, links: int = LINKS) -> Predict:
    """How far the second joint opens [m]: it carries all but one link, and feels half of a link's mass: F / (m w^2)."""

    def predicted(world: World, dt: float) -> float:
        omega = 2.0 * math.pi * weakest_hertz(world, dt)
        return 2.0 * (ratio + links - 1.0) * GRAVITY / omega**2

    return predicted


def hangs(ratio: float) -> tuple[Criterion, ...]:
    """Joints open as the springs say that they are, at most, and nothing moves."""
    return (
        Criterion("a joint's anchors are apart by", gap, "m", 8.0, at_most=and_a_fifth(hung(ratio))),
        Criterion(
            "from where it began, with a joint open by 2 cm, a body has come by",
            lambda world: moved(world, 1, BEGIN),
            unit="m",
            after=8.0,
            at_least=0.4 * OPEN,  # of two that come together, one goes half the way, but for what springs leave open
        ),
        Criterion("the fastest link still moves at", fastest, "m/s", 8.0, at_most=CALM),
    )


def hanging(ratio: float) -> Build:
    """Builds a chain with an end so many times as heavy as a link."""

    def build(world: World) -> None:
        chain = hang(world, LENGTH)
        end = world.create_body(
            Circle(END), position=(0.0, -LENGTH - END), mass=ratio * Capsule(LENGTH / LINKS, 0.5 * WIDTH).area
        )
        world.create_joint_revolute(chain[-1], end, anchor=(0.0, -LENGTH), collide_connected=False)
        end.position = (0.0, -LENGTH - END - OPEN)

    return build


def hang(world: World, length: float) -> list[Body]:
    """A chain that hangs straight down."""
    return add_chain(world, world.create_body(kind="static"), (0.0, 0.0), (0.0, -length), LINKS, WIDTH)


@scene("Robustness/Heavy Chain End", shows=hangs(100.0), view=(0.0, -5.5, 13.0))
def heavy_chain_end(world: World) -> None:
    """Twenty links carry a weight of a hundred links: it may stretch them as far as they are soft, and no more."""
    hanging(100.0)(world)


# --- stretched --------------------------------------------------------------------------------------------------------

APART = 0.25  # of neighbouring links, in the beginning [m]
CONTRACTS = 5.0  # [s]


@scene(
    "Robustness/Stretched Chain",
    shows=(
        Criterion("a joint's anchors are apart by", gap, "m", CONTRACTS, at_most=0.02 * LENGTH / LINKS),  # of a link
        Criterion(
            "the fastest link moves at",
            fastest,
            unit="m/s",
            after=CONTRACTS,
            at_most=math.sqrt(
                2.0 * GRAVITY * (LENGTH + LINKS * APART)
            ),  # no faster than if it had fallen all its length
        ),
    ),
    view=(0.0, -6.0, 18.0),
)
def stretched_chain(world: World) -> None:
    """A chain whose links begin apart: its joints close, and it hangs. As Solver2D's."""
    chain = hang(world, LENGTH)
    for k, link in enumerate(chain):
        x, y = link.position
        link.position = (x, y - APART * (k + 1))
